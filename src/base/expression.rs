//! The arithmetic of number entries: `5` and `-18` are values, `+=3` and `*1.1` change the old value, everything else is
//! computed over named variables. A parser of our own: it is small, its limits are ours, and it evaluates as it reads.
//!
//! Comparisons are 1 where they hold and 0 where they do not; `and`, `or` and `not` join them, and a word is compared with
//! `==` and `!=`. Angles are degrees, as they are everywhere in a scene. A comma between digits is a decimal point (`4,5`), except in the
//! list of a function's arguments, where it separates them; a true minus sign (U+2212) is a minus.

use super::maths;
use functions::{FUNCTIONS, Function};

mod conditions;
mod functions;

/// The longest expression, in bytes.
pub const LIMIT_BYTES: usize = 4096;
/// The deepest nesting of parentheses, functions and signs.
pub const LIMIT_DEPTH: usize = 64;

/// What an expression may name.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variables<'a> {
    /// Numbers; `v` is the old value.
    pub numbers: &'a [(&'a str, f64)],
    /// Words, which are only compared.
    pub words: &'a [(&'a str, &'a str)],
}

impl<'a> Variables<'a> {
    /// Numbers alone.
    pub fn numbers(numbers: &'a [(&'a str, f64)]) -> Self {
        Variables { numbers, words: &[] }
    }

    fn get(&self, name: &str) -> Option<f64> {
        self.numbers.iter().find(|(known, _)| *known == name).map(|&(_, value)| value)
    }

    fn names(&self) -> String {
        let words = self.words.iter().map(|&(name, _)| name);
        self.numbers.iter().map(|&(name, _)| name).chain(words).collect::<Vec<_>>().join(" ")
    }
}

/// Why an expression has no value.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {what}")]
pub struct Mistake {
    /// Where, counted in characters from 1.
    pub column: usize,
    /// What was found there.
    pub what: String,
    /// Whether it can be read, but its value is not a finite number.
    pub endless: bool,
}

impl Mistake {
    fn at(column: usize, what: impl Into<String>) -> Mistake {
        Mistake { column, what: what.into(), endless: false }
    }
}

/// The names of all functions, for help.
pub fn functions() -> impl Iterator<Item = &'static str> {
    FUNCTIONS.iter().map(|f| f.name)
}

/// The value of an entry. `variables` holds the old value as `v`. The result is finite.
pub fn evaluate(text: &str, variables: &Variables) -> Result<f64, Mistake> {
    if text.len() > LIMIT_BYTES {
        return Err(Mistake::at(LIMIT_BYTES + 1, format!("longer than {LIMIT_BYTES} bytes")));
    }
    let trimmed = text.trim();
    let start = text.len() - text.trim_start().len();
    let (operator, skip) = match relative(trimmed) {
        Some((operator, skip)) => (Some(operator), skip),
        None => (None, usize::from(trimmed.starts_with('='))),
    };
    let mut parser = Parser { text, at: start + skip, depth: 0, lists: 0, variables };
    let right = parser.any()?;
    parser.space();
    if let Some(found) = parser.peek() {
        return Err(parser.mistake(format!("expected an operator, found `{found}`{}", hint(found))));
    }
    let old = variables.get("v").ok_or(Mistake::at(1, "there is no value to change"));
    let value = match operator {
        Some('+') => old? + right,
        Some('-') => old? - right,
        Some('*') => old? * right,
        Some(_) => old? / right,
        None => right,
    };
    match value.is_finite() {
        true => Ok(value),
        false => Err(Mistake { endless: true, ..Mistake::at(1, "the result is not a finite number") }),
    }
}

/// What other languages write for what is a word here, or doubled.
fn hint(found: char) -> &'static str {
    match found {
        '=' => ": equal is ==",
        '&' => ": both is `and`",
        '|' => ": either is `or`",
        '!' => ": the opposite is `not`, unequal is !=",
        _ => "",
    }
}

/// The operator of a relative entry and how many bytes it takes.
fn relative(text: &str) -> Option<(char, usize)> {
    let found = text.chars().next().filter(|c| "+-−*/".contains(*c))?;
    let (operator, after) = (if found == '−' { '-' } else { found }, found.len_utf8());
    match (operator, text[after..].starts_with('=')) {
        (_, true) => Some((operator, after + 1)),
        ('*' | '/', false) => Some((operator, after)),
        _ => None,
    }
}

fn is_of_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    /// How many argument lists the parser is in.
    lists: usize,
    variables: &'a Variables<'a>,
}

impl Parser<'_> {
    fn mistake(&self, what: impl Into<String>) -> Mistake {
        Mistake::at(self.text[..self.at].chars().count() + 1, what)
    }

    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn space(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    fn take(&mut self, wanted: char) -> bool {
        self.space();
        let found = self.peek().filter(|&c| c == wanted || (c, wanted) == ('−', '-'));
        self.at += found.map_or(0, char::len_utf8);
        found.is_some()
    }

    /// Takes the longest run of characters that `wanted` accepts.
    fn run(&mut self, wanted: impl Fn(char) -> bool) -> String {
        let end = self.rest().find(|c| !wanted(c)).unwrap_or(self.rest().len());
        let taken = self.rest()[..end].to_string();
        self.at += end;
        taken
    }

    fn sum(&mut self) -> Result<f64, Mistake> {
        let mut value = self.product()?;
        loop {
            if self.take('+') {
                value += self.product()?;
            } else if self.take('-') {
                value -= self.product()?;
            } else {
                return Ok(value);
            }
        }
    }

    fn product(&mut self) -> Result<f64, Mistake> {
        let mut value = self.signed()?;
        loop {
            if self.take('*') {
                value *= self.signed()?;
            } else if self.take('/') {
                value /= self.signed()?;
            } else if self.take('%') {
                value %= self.signed()?;
            } else {
                return Ok(value);
            }
        }
    }

    /// A sign binds looser than a power: -2^2 is -4.
    fn signed(&mut self) -> Result<f64, Mistake> {
        self.depth += 1;
        if self.depth > LIMIT_DEPTH {
            return Err(self.mistake(format!("nested deeper than {LIMIT_DEPTH}")));
        }
        let value = if self.take('-') {
            -self.signed()?
        } else if self.take('+') {
            self.signed()?
        } else {
            let base = self.atom()?;
            if self.take('^') { maths::pow(base, self.signed()?) } else { base }
        };
        self.depth -= 1;
        Ok(value)
    }

    fn atom(&mut self) -> Result<f64, Mistake> {
        if self.take('(') {
            let value = self.any()?;
            return if self.take(')') { Ok(value) } else { Err(self.mistake("expected `)`")) };
        }
        match self.peek() {
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.name(),
            Some(c) => Err(self.mistake(format!("expected a number, found `{c}`{}", hint(c)))),
            None => Err(self.mistake("expected a number, found the end")),
        }
    }

    fn number(&mut self) -> Result<f64, Mistake> {
        let start = self.at;
        // In a list of arguments a comma ends the number.
        let comma = self.lists == 0;
        self.run(|c| c.is_ascii_digit() || c == '.');
        while comma && self.rest().strip_prefix(',').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
        {
            self.at += 1;
            self.run(|c| c.is_ascii_digit() || c == '.');
        }
        let sign = |c: char| matches!(c, '+' | '-' | '−');
        let exponent = self.rest().strip_prefix(['e', 'E']).map(|rest| rest.strip_prefix(sign).unwrap_or(rest));
        if let Some(digits) = exponent.filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) {
            self.at = self.text.len() - digits.len();
            self.run(|c| c.is_ascii_digit());
        }
        let text = &self.text[start..self.at];
        let plain = text.replace('−', "-");
        let plain = if plain.contains('.') { plain } else { plain.replacen(',', ".", 1) };
        let value = plain.parse().map_err(|_| format!("`{text}` is not a number"));
        value.map_err(|what| Mistake::at(self.text[..start].chars().count() + 1, what))
    }

    fn name(&mut self) -> Result<f64, Mistake> {
        let before = self.mistake("");
        let name = self.run(is_of_name);
        if let Some(value) = self.variables.get(&name) {
            return Ok(value);
        }
        if name == "pi" {
            return Ok(std::f64::consts::PI);
        }
        match FUNCTIONS.iter().find(|f| f.name == name) {
            Some(function) => self.call(function),
            None if ["nan", "inf", "infinity"].contains(&name.to_lowercase().as_str()) => {
                Err(Mistake { what: format!("`{name}` is not a finite number"), ..before })
            }
            None => Err(Mistake {
                what: format!("`{name}` is not known here (known: {}, pi, sqrt and the like)", self.variables.names()),
                ..before
            }),
        }
    }

    fn call(&mut self, function: &Function) -> Result<f64, Mistake> {
        if !self.take('(') {
            return Err(self.mistake(format!("expected `(` after {}", function.name)));
        }
        self.lists += 1;
        let mut arguments = vec![self.any()?];
        while self.take(',') {
            arguments.push(self.any()?);
        }
        self.lists -= 1;
        if !self.take(')') {
            return Err(self.mistake("expected `,` or `)`"));
        }
        match function.arguments {
            Some(n) if n != arguments.len() => {
                let s = if n == 1 { "" } else { "s" };
                let found = arguments.len();
                let hint = if found > n { " (here a comma separates: write 4.5)" } else { "" };
                Err(self.mistake(format!("{} takes {n} number{s}, found {found}{hint}", function.name)))
            }
            _ => Ok((function.apply)(&arguments)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VARIABLES: Variables = Variables {
        numbers: &[("v", 10.0), ("x", 3.0), ("w", 1280.0), ("r", 2.0), ("i", 0.0)],
        words: &[("tool", "still-border"), ("name", "left eye")],
    };

    const ENTRIES: &[(&str, f64)] = &[
        ("5", 5.0),
        (" -18 ", -18.0),
        ("+5", 5.0),
        (".5", 0.5),
        ("1e-3", 0.001),
        ("+=3", 13.0),
        ("-= 3", 7.0),
        ("*=1.5", 15.0),
        ("/=4", 2.5),
        ("*0.5", 5.0),
        ("/2+3", 2.0),
        ("=w/2", 640.0),
        ("w/2", 640.0),
        ("1280/2", 640.0),
        ("v+1", 11.0),
        ("-x", -3.0),
        ("-2^2", -4.0),
        ("2^3^2", 512.0),
        ("2*(1+2)", 6.0),
        ("7%4", 3.0),
        ("2^-1", 0.5),
        ("sqrt(2)*r", 2.0 * std::f64::consts::SQRT_2),
        ("min(3, x-1, 9)", 2.0),
        ("round(sin(30)*100)", 50.0),
        ("2*pi", std::f64::consts::TAU),
        ("4,5", 4.5),
        ("-4,5", -4.5),
        ("+=4,5", 14.5),
        ("*1,1", 11.0),
        ("1,5e2", 150.0),
        ("2*(1,5+x)", 9.0),
        ("min(4,5)", 4.0),
        ("max((1+1), 2,5)", 5.0),
        ("min(9, 4)+0,5", 4.5),
        ("−18", -18.0),
        ("5 − 3", 2.0),
        ("−=3", 7.0),
        ("2^−1", 0.5),
        ("1e−3", 0.001),
        ("x > 2", 1.0),
        ("x<2", 0.0),
        ("x>=3", 1.0),
        ("x<=2.9", 0.0),
        ("0.1+0.2==0.3", 1.0),
        ("0.1+0.2>0.3", 0.0),
        ("x!=3", 0.0),
        ("x>1 and v<5", 0.0),
        ("x>1 or v<5", 1.0),
        ("not x>1 or v==10", 1.0),
        ("not (x>1 or v==10)", 0.0),
        ("not not 5", 5.0),
        ("v*(x>2)", 10.0),
        ("if(x>2, 7, 8)", 7.0),
        ("if(i, 1/i, 8)", 8.0),
        ("*if(x==3, 2, 1)", 20.0),
        ("clamp(v, 0, 4)+clamp(-1, 0, 4)", 4.0),
        ("sign(-3)+sign(0)", -1.0),
        ("hypot(x, 4)", 5.0),
        ("lerp(2, 6, 0.25)", 3.0),
        ("tool==still-border and x==3", 1.0),
        ("tool != point", 1.0),
        ("name == \"left eye\"", 1.0),
        ("not name==left", 1.0),
    ];

    #[test]
    fn entries_and_their_values() {
        for (text, value) in ENTRIES {
            assert_eq!(evaluate(text, &VARIABLES), Ok(*value), "{text}");
        }
    }

    #[test]
    fn mistakes_tell_their_place() {
        for (text, column, part) in [
            ("", 1, "found the end"),
            ("5 5", 3, "operator"),
            ("2*q", 3, "`q` is not known"),
            ("2*NaN", 3, "`NaN` is not a finite number"),
            ("(1", 3, "`)`"),
            ("1.2.3", 1, "not a number"),
            ("sqrt(1,2)", 10, "takes 1 number, found 2 (here a comma separates"),
            ("4,", 2, "operator, found `,`"),
            (",5", 1, "a number, found `,`"),
            ("4, 5", 2, "operator, found `,`"),
            ("1,234,567", 1, "not a number"),
            ("1.234,5", 1, "not a number"),
            ("−−", 3, "found the end"),
            ("sqrt", 5, "expected `(`"),
            ("1/0", 1, "finite"),
            ("sqrt(-1)", 1, "finite"),
            ("5é", 2, "operator"),
            ("é+", 1, "not known"),
            ("x=3", 2, "found `=`: equal is =="),
            ("x>1 && x<5", 5, "found `&`: both is `and`"),
            ("x>1||x<5", 4, "found `|`: either is `or`"),
            ("!x", 1, "found `!`: the opposite is `not`"),
            ("x!", 2, "found `!`: the opposite is `not`"),
            ("1<x<5", 5, "two are compared at a time: join with and"),
            ("if(x)", 6, "if takes 3 numbers, found 1"),
            ("x and", 6, "found the end"),
            ("tool>3", 5, "expected == or !=: tool is a word"),
            ("tool+1", 5, "tool is a word"),
            ("name==\"a", 9, "`\"`"),
            ("android", 1, "not known"),
        ] {
            let mistake = evaluate(text, &VARIABLES).unwrap_err();
            assert!(mistake.column == column && mistake.what.contains(part), "{text}: {mistake}");
        }
    }

    #[test]
    fn absurd_input_is_refused() {
        for text in [
            "(".repeat(4000),
            "-".repeat(4000),
            "2^".repeat(2000),
            "1".repeat(5000),
            "sqrt(".repeat(800),
            "not ".repeat(900),
        ] {
            assert!(evaluate(&text, &VARIABLES).is_err());
        }
        assert!(evaluate(&format!("{}1{}", "(".repeat(60), ")".repeat(60)), &VARIABLES).is_ok());
    }
}
