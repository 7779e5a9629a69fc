//! `plica set`: scripted edits, all of them or none, by the same patches as in the editor.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::Context;
use super::scene_options::{RecoveryOptions, SceneOptions};
use crate::base::error::{Error, Result};
use crate::base::expression::{Variables, evaluate};
use crate::base::number;
use crate::base::pointer::Pointer;
use crate::base::problem::{self, Problem};
use crate::files::session::{Mode, Overwrite, Session, Taken};
use crate::files::{Options, materials};
use crate::preview::editor::script;
use crate::scene::field::{self, Kind};
use crate::scene::presets::Applied;
use crate::scene::schema::{Body, Place};
use crate::scene::{Document, Edit, address};

/// Set values in a scene
#[derive(clap::Args)]
pub struct Args {
    /// The scene
    scene: PathBuf,
    /// What to set, for example layers.face.zones."left eye".feather=4; a value that is not JSON is text; null removes
    /// something optional; PATH*=2, +=, -= and /= change a number, which may be computed (PATH=v*2, v the old one); * stands
    /// for all, as in layers.*.zones.*.speed=i/n; a word alone chooses a kind, as in layers.face.zones.lid.position=sine
    #[arg(required = true, value_name = "PATH=VALUE")]
    settings: Vec<String>,
    #[command(flatten)]
    recovery: RecoveryOptions,
    #[command(flatten)]
    reading: SceneOptions,
}

/// How long to wait for another process that is changing the scene and is not an editor that can do the setting for us.
const PATIENCE: Duration = Duration::from_secs(10);
/// How often to check whether it is done.
const LOOK_EVERY: Duration = Duration::from_millis(20);
/// A process that has had the scene for longer than this is not another `plica set`.
const BRIEF_MS: u64 = 5_000;

/// Sets the values: in the editor that has the scene open, otherwise in the file.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let lost = RefCell::default();
    let options = args.reading.options()?;
    let make = |document: &Document| {
        let set = edit(document, &args.settings, (&args.scene, ""))?;
        let remarks = set.remarks(document, &args.scene, &options);
        lost.replace(remarks);
        Ok(set.edit)
    };
    let elsewhere = change(&args.scene, (&args.recovery, &args.reading), make)?;
    lost.take().iter().for_each(|line| context.messages.say(line));
    if elsewhere {
        context.messages.say("set in the editor that has the scene open; save it there");
    }
    Ok(())
}

/// Applies the edit that `make` gives for a scene; whether that was in the editor that has it open, otherwise in the file.
///
/// # Errors
/// As `make`; if the scene cannot be read or written.
pub fn change(
    scene: &Path,
    (recovery, reading): (&RecoveryOptions, &SceneOptions),
    make: impl Fn(&Document) -> Result<Edit>,
) -> Result<bool> {
    refuse_input(scene)?;
    let options = reading.options()?;
    let begun = Instant::now();
    let mut session = loop {
        if let Some(done) = script::edit(scene, &make) {
            return done.map(|_| true);
        }
        let session = Session::open(scene, &options, Mode::EditOrLook)?;
        match session.held_by() {
            None => break session,
            Some(other) if !other.certain || begun.elapsed() > PATIENCE || other.has_been_there(BRIEF_MS) => {
                break Session::open(scene, &options, Mode::Edit)?;
            }
            Some(_) => std::thread::sleep(LOOK_EVERY),
        }
    };
    settle(&mut session, scene, recovery)?;
    let edit = make(session.document())?;
    session.refuse_protected()?;
    let applied = session.apply(edit, false).map_err(|problems| refused(scene, problems))?;
    session.save(Overwrite::No).inspect_err(|_| {
        // An edit that could not be saved is not left behind for recovery either.
        applied.and_then(|_| session.undo());
    })?;
    Ok(false)
}

/// Makes one change to a scene, as [`change`], and tells what it did; `make` says in words why it cannot be made.
///
/// # Errors
/// As [`change`].
pub fn apply(
    scene: &Path,
    options: (&RecoveryOptions, &SceneOptions),
    make: impl Fn(&Document) -> std::result::Result<Applied, String>,
    context: &mut Context,
) -> Result<()> {
    let told = RefCell::default();
    let elsewhere = change(scene, options, |document| {
        let Applied { edit, told: words } = make(document).map_err(|why| Error::at(scene.display(), why))?;
        told.replace(words);
        Ok(edit)
    })?;
    context.messages.say(&told.take());
    if elsewhere {
        context.messages.say("that was in the editor that has the scene open; save it there");
    }
    Ok(())
}

/// Refuses standard input, which cannot be written back.
///
/// # Errors
/// If the scene is standard input.
pub fn refuse_input(scene: &Path) -> Result<()> {
    match scene.as_os_str() == "-" {
        true => Err(Error::Usage("what is changed has to be a file: - is standard input, which is only read".into())),
        false => Ok(()),
    }
}

/// Takes over or discards unsaved edits that a session left behind; without the option that says which, it is an error.
fn settle(session: &mut Session, scene: &Path, recovery: &RecoveryOptions) -> Result<()> {
    let Some(offer) = session.recovery() else { return Ok(()) };
    let place = scene.display();
    match recovery.keep() {
        None => {
            let error = Error::at(place, format!("{} left behind, and nothing is set", offer.in_words()));
            Err(error.cure("--after-recovery keep takes them, drop leaves them; plica edit shows them"))
        }
        Some(false) => {
            session.discard_recovery();
            Ok(())
        }
        Some(true) => {
            session.recover();
            match session.take_in(None)? {
                (Taken::Asked(places), _) => {
                    let what = format!("another program changed what is unsaved too: {}", places.join("; "));
                    Err(Error::at(place, what).cure("plica edit asks which counts"))
                }
                _ => Ok(()),
            }
        }
    }
}

/// What settings do to a scene.
pub struct Set {
    /// The edit.
    pub edit: Edit,
    /// What it leads to.
    pub after: Document,
    /// What a change of kind could not keep, one line each.
    pub lost: Vec<String>,
    /// How many places it sets.
    pub places: usize,
}

impl Set {
    /// What is to be said of it, one line each: what is lost, what has no effect, and files that cannot be read.
    pub fn remarks(&self, before: &Document, scene: &Path, options: &Options) -> Vec<String> {
        let unread = materials::unread(scene, [before, &self.after], options);
        let unread = unread.iter().map(|problem| address::of_problem(&self.after, problem).to_string());
        let camera = without_camera(before, &self.after);
        self.lost.iter().cloned().chain(self.edit.overruled(before)).chain(camera).chain(unread).collect()
    }
}

/// That a setting has given a scene a camera, if nothing says where that stands.
fn without_camera(before: &Document, after: &Document) -> Option<String> {
    let made = before.scene().camera.is_none().then(|| after.json().get("camera")?.as_object())??;
    let stands = ["position", "target", "keys"].iter().any(|field| made.contains_key(*field));
    let told =
        "the scene had no camera: this one stands where every camera begins (in the editor :camera fit sees all)";
    (!stands).then(|| told.to_owned())
}

/// The edit that applies all of `settings` (`PATH=VALUE`), each to the result of those before it. One that is only right after
/// another waits for that. A path that begins with a dot is looked for around the place `here` of the scene.
pub fn edit(document: &Document, settings: &[String], (scene, here): (&Path, &str)) -> Result<Set> {
    let mut all = Set { edit: Edit::default(), after: document.clone(), lost: Vec::new(), places: 0 };
    let mut waiting: Vec<&String> = settings.iter().collect();
    while !waiting.is_empty() {
        let (before, mut refusal) = (waiting.len(), None);
        waiting.retain(|setting| match one(&all.after, setting, (scene, here)) {
            Ok(set) => {
                all.after = set.after;
                all.edit = Edit::all([std::mem::take(&mut all.edit), set.edit]);
                all.lost.extend(set.lost);
                all.places += set.places;
                false
            }
            Err(error) => {
                refusal.get_or_insert(error);
                true
            }
        });
        if let Some(error) = refusal.filter(|_| waiting.len() == before) {
            return Err(error);
        }
    }
    Ok(all)
}

/// The document after one setting, and what that did to it.
fn one(document: &Document, setting: &str, (scene, here): (&Path, &str)) -> Result<Set> {
    let mut all = Set { edit: Edit::default(), after: document.clone(), lost: Vec::new(), places: 0 };
    let whole = around(document, here, setting)?;
    let setting = Setting::read(document, &whole)?;
    let pointers = address::resolve_all(document, setting.path)?;
    // Places that are written do not touch one another; others may begin what they share.
    let written = |pointer: &String| Pointer(pointer).parent().is_some_and(|at| document.json().pointer(at).is_some());
    let at_once = if pointers.iter().all(written) { pointers.len().max(1) } else { 1 };
    all.places = pointers.len();
    for (k, some) in pointers.chunks(at_once).enumerate() {
        let mut edits = Vec::new();
        for (i, pointer) in some.iter().enumerate() {
            let pointer = &setting.meant(&all.after, pointer);
            let value = setting.value(&all.after, pointer, (k * at_once + i, all.places))?;
            let (edit, lost) = Edit::set_told(&all.after, pointer, value);
            all.lost.extend(lost.map(|lost| format!("{}: {lost}", address::address(&all.after, pointer))));
            edits.push(edit);
        }
        let edit = Edit::all(edits);
        all.after = all.after.apply(&edit).map_err(|problems| {
            refused(scene, problems.iter().map(|problem| address::of_problem(&all.after, problem)).collect())
        })?;
        all.edit = Edit::all([std::mem::take(&mut all.edit), edit]);
    }
    Ok(all)
}

/// A setting, taken apart.
struct Setting<'a> {
    path: &'a str,
    value: Value,
    /// The value as it is written.
    text: &'a str,
    /// The number that it means: it is computed, over the old value.
    computed: Option<String>,
    /// Whether it changes the old value, so that there has to be a number.
    relative: bool,
}

impl<'a> Setting<'a> {
    fn read(document: &Document, setting: &'a str) -> Result<Setting<'a>> {
        let (path, value) = parse(setting)?;
        let text = &setting[path.len() + 1..];
        // A name may end with such a sign.
        let own = |path| address::resolve_all(document, path).is_ok();
        let sign = path.chars().last().filter(|sign| "+-*/".contains(*sign));
        let field = sign.map(|sign| (&path[..path.len() - sign.len_utf8()], sign));
        // A `*` that is a step of its own, or a whole pointer, is no operator.
        let field = field.filter(|(field, _)| !field.is_empty() && !field.ends_with(['.', '/']));
        Ok(match field.filter(|_| !own(path)) {
            Some((path, sign)) => {
                Setting { path, value, text, computed: Some(format!("{sign}={text}")), relative: true }
            }
            None => {
                // Text that is not JSON, where a number is wanted: `v*2`, `1/3`, `4,5`.
                let plain = value == text;
                Setting { path, value, text, computed: plain.then(|| text.to_owned()), relative: false }
            }
        })
    }

    /// The place that it sets: of something that there are several kinds of, a word is the kind.
    fn meant(&self, document: &Document, pointer: &str) -> String {
        let place = Place::of(document.json(), pointer).map(|place| place.shape);
        let kind = place.zip(self.value.as_str()).and_then(|(shape, word)| match shape.body() {
            Body::Tagged(tag) => shape.variant(word).map(|_| Pointer(pointer).join(tag)),
            _ => None,
        });
        kind.unwrap_or_else(|| pointer.to_owned())
    }

    /// The value for one of its places, the `i`th of `n`.
    fn value(&self, document: &Document, pointer: &str, (i, n): (usize, usize)) -> Result<Value> {
        let kind = field::field(document, pointer).map(|field| field.kind);
        match (&self.computed, kind) {
            (Some(expression), Some(Kind::Number { .. })) => {
                let old = field::counting(document, pointer).and_then(|value| value.as_f64());
                let known = [("i", i as f64), ("n", n as f64)];
                let known: Vec<(&str, f64)> = old.map(|old| ("v", old)).into_iter().chain(known).collect();
                let value = evaluate(expression, &Variables::numbers(&known));
                let value = value.map_err(|mistake| Error::at(self.path, format!("{expression}: {mistake}")))?;
                Ok(number::json(number::tidy(value)))
            }
            _ if self.relative => Err(Error::at(self.path, "is not a number, so that it cannot be changed by one")),
            // A value that looks like other JSON is text if only text fits (`title=2024`).
            (_, Some(Kind::Text)) if !self.value.is_string() && !self.value.is_null() => Ok(self.text.into()),
            _ => Ok(self.value.clone()),
        }
    }
}

/// A setting with a whole path: one that begins with a dot is looked for around the place `here`.
///
/// # Errors
/// If there is no such thing around it.
pub fn around(document: &Document, here: &str, setting: &str) -> Result<String> {
    let path = &setting[..equals(setting).unwrap_or(setting.len())];
    let path = path.trim_end_matches(['+', '-', '*', '/']);
    Ok(address::around(document, here, path)? + &setting[path.len()..])
}

/// Splits a line of settings: a space ends a setting if the `PATH=` of another follows. So a text with spaces needs no
/// quotes unless a word in it looks like that.
pub fn settings(document: &Document, line: &str) -> Vec<String> {
    let mut all = vec![String::new()];
    let (mut quoted, mut depth) = (false, 0i32);
    for (at, c) in line.char_indices() {
        match c {
            '"' if !line[..at].ends_with('\\') => quoted = !quoted,
            '[' | '{' if !quoted => depth += 1,
            ']' | '}' if !quoted => depth -= 1,
            // A name with a space, as `left eye.feather=3`, is no end of a setting: that has its `=`.
            ' ' if !quoted && depth <= 0 && is_set(&all) && begins(document, line[at..].trim_start()) => {
                all.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(last) = all.last_mut() {
            last.push(c);
        }
    }
    all.into_iter().map(|one| one.trim().to_owned()).filter(|one| !one.is_empty()).collect()
}

/// Whether the last of these settings has a value.
fn is_set(all: &[String]) -> bool {
    all.last().is_some_and(|last| equals(last).is_some())
}

/// Where the first `=` outside quotes is.
fn equals(setting: &str) -> Option<usize> {
    let mut inside = false;
    let found = setting.char_indices().find(|&(_, c)| {
        inside ^= c == '"';
        c == '=' && !inside
    });
    found.map(|(at, _)| at)
}

/// Whether a setting begins here: with a path of the scene, or with something that looks like one.
fn begins(document: &Document, text: &str) -> bool {
    let mut quoted = false;
    let end = text.find(|c: char| {
        quoted ^= c == '"';
        !quoted && (c == '=' || c == ' ')
    });
    let path = end.filter(|&end| text[end..].starts_with('=')).map_or("", |end| &text[..end]);
    path.contains(['.', '/']) || !path.is_empty() && address::resolve(document, path).is_ok()
}

fn refused(scene: &Path, problems: Vec<Problem>) -> Error {
    Error::Scene { file: scene.display().to_string(), problems }
}

/// Splits at the first `=` outside quotes; the value is JSON if it can be read as JSON, otherwise text.
pub fn parse(setting: &str) -> Result<(&str, Value)> {
    let Some(at) = equals(setting) else {
        let how = match setting.rsplit_once(' ').filter(|(path, _)| !path.contains(' ')) {
            Some((path, value)) => format!("{path}={value}"),
            None => "PATH=VALUE, a name with a space in quotes".to_owned(),
        };
        return Err(Error::Usage(format!("{setting}: write it as {how}")));
    };
    let value = &setting[at + 1..];
    // A number that JSON cannot hold must not become text.
    match crate::scene::json::parse(value) {
        Ok(json) => Ok((&setting[..at], json)),
        Err(problem) if problem.kind == problem::Kind::TooLargeNumber => {
            Err(Error::at(&setting[..at], format!("{value} is too large a number")).cure(problem::LARGEST))
        }
        Err(_) => Ok((&setting[..at], Value::from(value))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Start;
    use serde_json::json;

    #[test]
    fn settings() {
        for (setting, expected) in [
            ("a.b=1", Some(("a.b", json!(1)))),
            ("a=[1, 2]", Some(("a", json!([1, 2])))),
            ("a=once", Some(("a", json!("once")))),
            ("a=\"1\"", Some(("a", json!("1")))),
            ("a=", Some(("a", json!("")))),
            ("a=b=c", Some(("a", json!("b=c")))),
            ("zones.\"x=y\".name=z", Some(("zones.\"x=y\".name", json!("z")))),
            ("a", None),
            ("a=1e999", None),
        ] {
            assert_eq!(parse(setting).ok(), expected, "{setting}");
        }
    }

    #[test]
    fn the_order_of_settings_does_not_matter_where_one_asks_for_another() {
        let document = Start::default().picture("cat", "cat.png", (9, 9)).document().unwrap();
        let pair = ["layers.cat.color=#203040", "layers.cat.kind=fill"].map(str::to_owned);
        let edited = |settings: &[String]| edit(&document, settings, (Path::new("s"), "")).map(|set| set.edit);
        for settings in [pair.to_vec(), pair.iter().rev().cloned().collect()] {
            let after = document.apply(&edited(&settings).unwrap()).unwrap();
            assert_eq!(after.json()["layers"][0], json!({ "kind": "fill", "name": "cat", "color": "#203040" }));
        }
        let wrong = ["layers.cat.colour=3", "title=a"].map(str::to_owned);
        let wrong = edited(&wrong).map(drop).unwrap_err().to_string();
        assert!(wrong.contains("\"colour\""), "what is wrong is told: {wrong}");
    }

    #[test]
    fn a_word_chooses_the_kind_of_what_has_several() {
        let document = Start::default().picture("cat", "cat.png", (9, 9)).document().unwrap();
        for (setting, pointer, expected) in [
            (".position=sine", "/position", json!({ "function": "sine" })),
            (".interpolation=rigid", "/interpolation", json!({ "method": "rigid" })),
            (".outline=ellipse", "/outline/radii", json!([4.5, 4.5])),
            (".motion.-=still-border", "/motion/0", json!({ "tool": "still-border", "spacing": 8 })),
            (".feather+=2", "/feather", json!(2)),
            (".timeline.fps=25", "/feather", json!(null)),
            (".fps=25", "/feather", json!(null)),
            (".power=3", "/interpolation/power", json!(3)),
        ] {
            let set = edit(&document, &[setting.to_owned()], (Path::new("s"), "/layers/0/zones/0/outline/x"));
            let after = document.apply(&set.unwrap_or_else(|why| panic!("{setting}: {why}")).edit).unwrap();
            let found = after.json()["layers"][0]["zones"][0].pointer(pointer).cloned().unwrap_or_default();
            assert_eq!(found, expected, "{setting}");
        }
        let wrong = |setting: &str| edit(&document, &[setting.to_owned()], (Path::new("s"), "")).map(drop);
        let nowhere = wrong(".feather=1").unwrap_err().to_string();
        assert!(nowhere.contains("there is no such thing around the cursor"), "{nowhere}");
        wrong("layers.cat.zones.all.position=zine").unwrap_err();
        let both = [".outline=polygon", ".position=keyframes", ".points=[[0,0]]"].map(str::to_owned);
        let several = edit(&document, &both, (Path::new("s"), "/layers/0/zones/0")).map(drop).unwrap_err().to_string();
        assert!(several.contains("outline.points or layers.cat.zones.all.position.points"), "{several}");
    }

    #[test]
    fn a_line_of_several_settings() {
        let document = Start::default().picture("cat", "cat.png", (9, 9)).document().unwrap();
        for (line, expected) in [
            ("title=two words", vec!["title=two words"]),
            ("title=a = b", vec!["title=a = b"]),
            ("title=a timeline.fps=5", vec!["title=a", "timeline.fps=5"]),
            ("timeline.fps=5  title=a b", vec!["timeline.fps=5", "title=a b"]),
            ("/timeline/fps=5 /title=x", vec!["/timeline/fps=5", "/title=x"]),
            ("layers.\"a b\".x=[1, 2] title=a", vec!["layers.\"a b\".x=[1, 2]", "title=a"]),
            ("title=\"x timeline.fps=5\"", vec!["title=\"x timeline.fps=5\""]),
        ] {
            assert_eq!(super::settings(&document, line), expected, "{line}");
        }
    }
}
