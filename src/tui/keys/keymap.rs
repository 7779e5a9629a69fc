//! The keys in use: the table, overridden by the person's own file. That file is TOML with a section for each context and
//! entries `"key sequence" = "line"`; an empty line unbinds the key. All mistakes are reported at once, each with its line
//! number, and the correct entries still apply.

use crate::tui::text::plain;
use std::borrow::Cow;

use toml::de::{DeTable, DeValue};

use super::names::{LETTERS, Meaning, continues, line_of, stands_for};
use super::table::{ENTRY, HELP, KEYS, LINE, LIST, TYPING};
use crate::base::problem;
use crate::tui::text::said::Said;

/// One key of the keymap.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// The context that it works in.
    pub context: &'static str,
    /// The key or keys, spelled as in the manual.
    pub key: Cow<'static, str>,
    /// The line that it runs.
    pub command: Cow<'static, str>,
    /// What it does, in a few words.
    pub help: Cow<'static, str>,
    /// Whether it is the person's own.
    pub own: bool,
}

/// All keys, and what is wrong in the person's own file.
#[derive(Clone, Debug)]
pub struct Keymap {
    rows: Vec<Binding>,
    mistakes: Vec<String>,
}

impl Default for Keymap {
    /// The table without any of the person's own keys.
    fn default() -> Self {
        let row = |row: &crate::base::keys::KeyRow| Binding {
            context: row.context,
            key: row.key.into(),
            command: row.command.into(),
            help: row.help.into(),
            own: false,
        };
        Keymap { rows: KEYS.iter().map(row).collect(), mistakes: Vec::new() }
    }
}

/// A binding as written in the file, with its line number.
struct Written {
    line: usize,
    context: &'static str,
    key: String,
    command: String,
}

impl Keymap {
    /// The table overridden by the keys of a file. Mistakes name `file`. `known` are all commands with their help.
    pub fn with(file: &str, text: &str, known: &[(String, &'static str)]) -> Keymap {
        let mut map = Keymap::default();
        let mut mistakes = Vec::new();
        let mut written = read(text, &mut mistakes);
        written.sort_by_key(|one| one.line);
        // Unbind first, so that the order in the file does not matter.
        let (away, own): (Vec<_>, Vec<_>) = written.into_iter().partition(|one| one.command.is_empty());
        for one in away {
            let before = map.rows.len();
            map.rows.retain(|row| (row.context, &*row.key) != (one.context, one.key.as_str()));
            if map.rows.len() == before {
                mistakes.push((
                    one.line,
                    format!("{} is not bound in [{}]: ? shows the keys that are", one.key, one.context),
                ));
            }
        }
        for one in own {
            if let Err(why) = map.bind(&one, known) {
                mistakes.push((one.line, why));
            }
        }
        mistakes.sort();
        map.mistakes = mistakes.into_iter().map(|(line, why)| format!("{file}:{line}: {why}")).collect();
        map
    }

    /// A file that could not be read.
    pub fn unread(why: String) -> Keymap {
        Keymap { mistakes: vec![why], ..Keymap::default() }
    }

    /// The mistakes in the person's own file.
    pub fn mistakes(&self) -> &[String] {
        &self.mistakes
    }

    /// Every key, the person's own first.
    pub fn rows(&self) -> &[Binding] {
        &self.rows
    }

    /// What the pressed keys mean in these contexts, the innermost first.
    pub fn find(&self, contexts: &[&str], pressed: &str) -> Meaning {
        for context in contexts {
            let mut rows = self.rows.iter().filter(|row| row.context == *context);
            if let Some(line) = rows.clone().find_map(|row| line_of(&row.key, &row.command, pressed)) {
                return Meaning::Line(line);
            }
            if rows.any(|row| continues(&row.key, pressed)) {
                return Meaning::Prefix;
            }
        }
        Meaning::Nothing
    }

    /// The key that runs a line in a context; `None` if no key does.
    pub fn key_of(&self, context: &str, command: &str) -> Option<&str> {
        let row = self.rows.iter().find(|row| row.context == context && row.command == command);
        row.map(|row| &*row.key)
    }

    /// The bindings that begin with the pressed keys, for the hints.
    pub fn continuations<'a>(
        &'a self,
        contexts: &'a [&str],
        pressed: &'a str,
    ) -> impl Iterator<Item = &'a Binding> + 'a {
        self.rows.iter().filter(move |row| contexts.contains(&row.context) && continues(&row.key, pressed))
    }

    fn bind(&mut self, one: &Written, known: &[(String, &'static str)]) -> Result<(), String> {
        let name = Said::parse(&one.command, None).name;
        if !known.iter().any(|(own, _)| own == name) {
            let near = problem::nearest(name, known.iter().map(|(own, _)| own.as_str())).unwrap_or_default();
            return Err(format!("there is no command {name}: {near}"));
        }
        let others = || self.rows.iter().filter(|row| row.context == one.context);
        if let Some(row) = others().find(|row| begins(&row.key, &one.key)) {
            return Err(format!(
                "{} can never be reached, because {} alone runs something: unbind that with \"{}\" = \"\"",
                one.key, row.key, row.key
            ));
        }
        let hidden: Vec<&str> = others().filter(|row| begins(&one.key, &row.key)).map(|row| &*row.key).collect();
        if let [first, rest @ ..] = hidden.as_slice() {
            let more = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
            return Err(format!("{} would hide {first}{more}: choose another key, or unbind those", one.key));
        }
        let help = help(&one.command, known);
        self.rows.retain(|row| (row.context, &*row.key) != (one.context, one.key.as_str()));
        let (key, command) = (one.key.clone().into(), one.command.clone().into());
        self.rows.insert(0, Binding { context: one.context, key, command, help, own: true });
        Ok(())
    }
}

/// The help for a line: from the table of keys, else that of its command.
fn help(line: &str, known: &[(String, &'static str)]) -> Cow<'static, str> {
    let row = KEYS.iter().find(|row| row.command == line).map(|row| row.help);
    let command = || known.iter().find(|(name, _)| name == line).map(|(_, help)| *help).filter(|help| !help.is_empty());
    row.or_else(command).map_or_else(|| Cow::Owned(plain(line)), Cow::Borrowed)
}

/// The well-formed bindings of a file.
fn read(text: &str, mistakes: &mut Vec<(usize, String)>) -> Vec<Written> {
    let line = |at: usize| text.bytes().take(at).filter(|&byte| byte == b'\n').count() + 1;
    let (table, errors) = DeTable::parse_recoverable(text);
    let wrong = |error: &toml::de::Error| (line(error.span().map_or(0, |span| span.start)), error.message().to_owned());
    mistakes.extend(errors.iter().map(wrong));
    let mut written = Vec::new();
    for (section, rows) in table.into_inner() {
        let name = section.get_ref();
        let context = KEYS.iter().map(|row| row.context).find(|context| context == name);
        let (Some(context), DeValue::Table(rows)) = (context, rows.get_ref()) else {
            let why = match rows.get_ref() {
                DeValue::Table(_) => {
                    let near = problem::nearest(name, contexts().into_iter()).unwrap_or_default();
                    format!("there is no section {}: {near}", problem::quoted(name))
                }
                _ => "keys belong in a section, such as [everywhere]".into(),
            };
            mistakes.push((line(section.span().start), why));
            continue;
        };
        for (key, command) in rows {
            let at = line(key.span().start);
            let DeValue::String(command) = command.get_ref() else {
                mistakes.push((at, "a key runs a line in quotes, such as \"undo\"".into()));
                continue;
            };
            match sequence(context, key.get_ref()) {
                Ok(key) => written.push(Written { line: at, context, key, command: command.trim().to_owned() }),
                Err(why) => mistakes.push((at, why)),
            }
        }
    }
    written
}

/// All contexts, in the order of the table.
pub fn contexts() -> Vec<&'static str> {
    let mut all: Vec<&str> = Vec::new();
    for row in KEYS.iter() {
        if !all.contains(&row.context) {
            all.push(row.context);
        }
    }
    all
}

/// Whether the sequence `long` begins with the keys `short`.
fn begins(short: &str, long: &str) -> bool {
    let (short, long): (Vec<_>, Vec<_>) = (short.split(' ').collect(), long.split(' ').collect());
    let same = |(a, b): (&&str, &&str)| a == b || stands_for(a, b) || stands_for(b, a);
    short.len() < long.len() && short.iter().zip(&long).all(same)
}

/// Keys whose names are longer than a letter.
const NAMED: &[&str] = &[
    "Space",
    "Enter",
    "Esc",
    "Tab",
    "Shift-Tab",
    "Backspace",
    "Delete",
    "Up",
    "Down",
    "Left",
    "Right",
    "Home",
    "End",
    "F1",
    "F2",
    "F3",
    "F4",
    "F5",
    "F6",
    "F7",
    "F8",
    "F9",
    "F10",
    "F11",
    "F12",
];

/// Keys that some or all terminals send as other keys.
const COME_AS: &[(&str, &str)] = &[
    ("Ctrl-h", "Backspace"),
    ("Ctrl-i", "Tab"),
    ("Ctrl-j", "Enter"),
    ("Ctrl-m", "Enter"),
    ("Ctrl-[", "Esc"),
    ("PageUp", "Ctrl-u"),
    ("PageDown", "Ctrl-d"),
];

/// Checks the keys of a binding and puts one space between them.
fn sequence(context: &str, written: &str) -> Result<String, String> {
    let keys: Vec<&str> = written.split_whitespace().collect();
    let first = keys.first().ok_or("there is no key between the quotes: the space bar is Space")?;
    for (at, key) in keys.iter().enumerate() {
        // Alone it binds every letter of its context; only lists have no letters of their own.
        if !LETTERS.contains(key) || (at == 0 && context != LIST) || at + 1 < keys.len() {
            check(key)?;
        }
    }
    let one = first.chars().count() == 1;
    let typing = [TYPING, ENTRY, LINE].contains(&context);
    if typing && (one || *first == "Space") {
        return Err(format!("{first} is typed here: choose a key with Ctrl- or Alt-, or one with a name"));
    }
    if !typing
        && ![LIST, HELP].contains(&context)
        && matches!(*first, "1" | "2" | "3" | "4" | "5" | "6" | "7" | "8" | "9")
    {
        return Err(format!("{first} begins a count here: choose another key"));
    }
    Ok(keys.join(" "))
}

fn check(key: &str) -> Result<(), String> {
    if let Some((_, other)) = COME_AS.iter().find(|(name, _)| *name == key) {
        return Err(format!("{key} is sent by terminals as {other}: write that"));
    }
    let control = key.strip_prefix("Ctrl-");
    let plain = control.unwrap_or(key);
    let plain = plain.strip_prefix("Alt-").unwrap_or(plain);
    let one = plain.chars().count() == 1 && !plain.contains(char::is_control);
    if one && control.is_some() && plain.contains(char::is_uppercase) {
        return Err(format!("Ctrl-{plain} is sent by terminals as Ctrl-{}: write that", plain.to_lowercase()));
    }
    if one || NAMED.contains(&plain) {
        return Ok(());
    }
    let alike = NAMED.iter().find(|name| name.eq_ignore_ascii_case(plain));
    let cure = alike.map_or("keys are written as ? shows them: j, Space, Ctrl-d, Alt-b, g g".into(), |name| {
        format!("did you mean {}?", key.replace(plain, name))
    });
    Err(format!("there is no key {}: {cure}", problem::quoted(key)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::commands::own_keys::read;
    use crate::tui::keys::{EVERYWHERE, TREE};

    #[test]
    fn own_keys_come_before_the_tables() {
        let map = read(
            "keys.toml",
            "[everywhere]\n\"U\" = \"5 undo\"\n\"Ctrl-s\" = \"w\"\n\"u\" = \"\"\n\"F2  {a-z}\" = \"play-macro {a-z}\"\n\
             [\"form and table\"]\n\"+\" = \"10 step 1\"\n",
        );
        assert_eq!(map.mistakes(), [""; 0]);
        for (context, pressed, expected) in [
            (EVERYWHERE, "U", Meaning::Line("5 undo".into())),
            (EVERYWHERE, "Ctrl-s", Meaning::Line("w".into())),
            (EVERYWHERE, "u", Meaning::Nothing),
            (EVERYWHERE, "F2", Meaning::Prefix),
            (EVERYWHERE, "F2 b", Meaning::Line("play-macro b".into())),
            (EVERYWHERE, "Ctrl-r", Meaning::Line("redo".into())),
            ("form and table", "+", Meaning::Line("10 step 1".into())),
            (TREE, "j", Meaning::Line("move down".into())),
        ] {
            assert_eq!(map.find(&[context], pressed), expected, "{context}: {pressed}");
        }
        let help = |key: &str| map.rows().iter().find(|row| row.own && row.key == key).unwrap().help.clone();
        assert_eq!((help("Ctrl-s").as_ref(), help("U").as_ref()), ("Save", "5 undo"));
        assert!(map.continuations(&[EVERYWHERE], "F2").next().is_some());
    }

    #[test]
    fn mistakes_are_told_by_their_lines_and_the_rest_holds() {
        for (text, line, part) in [
            ("[everywhere]\n\"U\" = undo", 2, "quote"),
            ("[everywhere]\n\"U\" = 5", 2, "in quotes"),
            ("\"U\" = \"undo\"", 1, "in a section"),
            ("[everwhere]\n\"U\" = \"undo\"", 1, "did you mean \"everywhere\""),
            ("[everywhere]\n\"U\" = \"unod\"", 2, "did you mean \"undo\""),
            ("[everywhere]\n\"U\" = \"undo\"\n\"U\" = \"redo\"", 3, "duplicate"),
            ("[everywhere]\n\"g g g\" = \"undo\"", 2, "\"g g\" = \"\""),
            ("[everywhere]\n\"g\" = \"undo\"", 2, "would hide g "),
            ("[everywhere]\n\"q a b\" = \"undo\"", 2, "q {a-z} alone"),
            ("[everywhere]\n\"Y Y\" = \"undo\"\n\"Y\" = \"redo\"", 3, "would hide Y Y"),
            ("[everywhere]\n\"ctrl-x\" = \"undo\"", 2, "keys are written as"),
            ("[everywhere]\n\"Ctrl-enter\" = \"undo\"", 2, "did you mean Ctrl-Enter?"),
            ("[everywhere]\n\"Ctrl-i\" = \"undo\"", 2, "is sent by terminals as Tab"),
            ("[everywhere]\n\"Ctrl-X\" = \"undo\"", 2, "Ctrl-x"),
            ("[everywhere]\n\" \" = \"undo\"", 2, "Space"),
            ("[everywhere]\n\"5 g\" = \"undo\"", 2, "count"),
            ("[everywhere]\n\"Q\" = \"\"", 2, "is not bound"),
            ("[entry]\n\"j j\" = \"cancel\"", 2, "is typed here"),
        ] {
            let map = read("keys.toml", &format!("{text}\n[tree]\n\"Y\" = \"add\"\n"));
            let told = map.mistakes().join("\n");
            assert!(told.starts_with(&format!("keys.toml:{line}: ")) && told.contains(part), "{text}: {told}");
            assert_eq!(map.mistakes().len(), 1, "{text}: {told}");
            assert_eq!(map.find(&[TREE], "Y"), Meaning::Line("add".into()), "{text}");
        }
        let many = read("k", "[tree]\n\"Ctrl-i\" = \"x\"\n\"x\" = \"xx\"\n[no]\n");
        let lines: Vec<_> = many.mistakes().iter().map(|told| told[..4].to_owned()).collect();
        assert_eq!(lines, ["k:2:", "k:3:", "k:4:"]);
    }

    #[test]
    fn every_key_of_the_table_could_be_written() {
        for row in KEYS.iter() {
            if let Err(why) = sequence(row.context, row.key) {
                panic!("{row:?}: {why}");
            }
        }
    }
}
