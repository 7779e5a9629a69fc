//! `plica man`: the manual as pages: the command line with every subcommand, the scene file, the keys of the editor.

mod keys;
mod roff;
mod scene;

use std::io;

use clap_mangen::Man;

use super::Context;
use crate::base::error::{Error, Result};

/// Print the manual
#[derive(clap::Args)]
pub struct Args {
    /// The page
    #[arg(value_enum, default_value_t)]
    page: Page,
}

/// A page of the manual.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
enum Page {
    /// The command line, exit status, environment and files: plica(1)
    #[default]
    Plica,
    /// The scene file, field by field: plica-scene(5)
    Scene,
    /// Keys and commands of the editor: plica-keys(7)
    Keys,
}

/// Prints a page in roff, for `man -l -`, that of the whole command line first.
pub fn run(args: Args, whole: clap::Command, context: &mut Context) -> Result<()> {
    let text = match args.page {
        Page::Plica => page(whole).map_err(|e| Error::at("the manual", e))?,
        Page::Scene => scene::page(),
        Page::Keys => keys::page(),
    };
    context.print(text.trim_end())
}

/// Exit statuses, as `Error::exit_status` has them.
const STATUS: &[(&str, &str)] = &[
    ("0", "done"),
    ("1", "the work failed: a bad scene, a file that cannot be read or written, problems that plica check found"),
    ("2", "a wrong command line"),
    ("130", "interrupted; nothing half-written is left"),
];

/// What of the environment counts.
const ENVIRONMENT: &[(&str, &str)] = &[
    ("NO_COLOR", "if it is set, nothing is colored"),
    ("COLORTERM, TERM", "which colors the terminal shows; TERM=dumb makes the editor read lines"),
    ("DISPLAY, WAYLAND_DISPLAY", "where the preview window opens"),
    ("PLICA_IMAGE_EDITOR", "the program that :image edit opens pictures in"),
    ("PLICA_REMOTE", "where plica is on the other machine, for plica view ssh://..."),
    ("PLICA_SSH", "the program to be used as ssh"),
    ("XDG_CONFIG_HOME", "its folder plica has keys.toml and styles (~/.config/plica)"),
    (
        "XDG_STATE_HOME",
        "its folder plica has the log, the logs of sessions and what the editor keeps (~/.local/state/plica)",
    ),
    ("XDG_CACHE_HOME", "its folder plica has unpacked demos and pictures from other machines (~/.cache/plica)"),
    ("XDG_RUNTIME_DIR", "its folder plica has the sockets of editors, else a private folder below the temporary one"),
];

/// The files beside a scene.
const FILES: &[(&str, &str)] = &[
    ("NAME.plica.json", "a scene: see plica man scene"),
    (".NAME.journal", "what was done to it, for undo and recovery; hidden, beside the scene"),
];

fn page(mut command: clap::Command) -> io::Result<String> {
    command.build();
    let mut page = Vec::new();
    let whole = Man::new(command.clone());
    whole.render_title(&mut page)?;
    whole.render_name_section(&mut page)?;
    whole.render_synopsis_section(&mut page)?;
    whole.render_description_section(&mut page)?;
    whole.render_options_section(&mut page)?;
    let mut page = String::from_utf8_lossy(&page).into_owned();
    for sub in command.get_subcommands().filter(|sub| sub.get_name() != "help") {
        page.push_str(&section(sub)?);
    }
    for (title, rows) in [("EXIT STATUS", STATUS), ("ENVIRONMENT", ENVIRONMENT), ("FILES", FILES)] {
        page.push_str(&format!(".SH {title}\n"));
        page.extend(rows.iter().map(|(name, help)| roff::tagged(name, "", help)));
    }
    page.push_str(".SH SEE ALSO\nplica man scene, plica man keys\n");
    let mut end = Vec::new();
    whole.render_extra_section(&mut end)?;
    whole.render_version_section(&mut end)?;
    page.push_str(&String::from_utf8_lossy(&end));
    // Every part has the same two lines of definitions; the first two are enough.
    let definitions: Vec<String> = page.lines().take(2).map(str::to_owned).collect();
    let lines = page.lines().enumerate().filter(|(i, line)| *i < 2 || !definitions.iter().any(|one| one == line));
    Ok(lines.map(|(_, line)| format!("{line}\n")).collect())
}

/// Tables and lines to copy: not filled, and nothing in them is a roff command.
fn as_it_stands(text: &str) -> String {
    let escape = |line: &str| format!("\\&{}\n", line.replace('\\', "\\e").replace('-', "\\-"));
    format!(".SH OUTPUTS\n.nf\n{}.fi\n", text.lines().map(escape).collect::<String>())
}

/// The section of one subcommand; what would be sections of a separate page become subsections.
fn section(command: &clap::Command) -> io::Result<String> {
    let mut parts = Vec::new();
    let man = Man::new(command.clone());
    man.render_synopsis_section(&mut parts)?;
    man.render_description_section(&mut parts)?;
    man.render_options_section(&mut parts)?;
    if let Some(more) = command.get_after_long_help().or(command.get_after_help()) {
        parts.extend(as_it_stands(&more.to_string()).into_bytes());
    }
    let parts = String::from_utf8_lossy(&parts).replace(".SH ", ".SS ");
    Ok(format!(".SH \"PLICA {}\"\n{parts}", command.get_name().to_uppercase()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manual_has_every_exit_status_and_all_that_counts_of_the_environment() {
        let page = page(<crate::ops::CommandLine as clap::CommandFactory>::command()).unwrap();
        for error in [Error::at("a", "b"), Error::Usage(String::new()), Error::Interrupted] {
            assert!(STATUS.iter().any(|(status, _)| *status == error.exit_status().to_string()), "{error:?}");
        }
        for (name, _) in STATUS.iter().chain(ENVIRONMENT).chain(FILES) {
            assert!(page.replace("\\&", "").contains(name), "{name}");
        }
    }

    #[test]
    fn the_manual_has_the_table_of_outputs() {
        let page = page(<crate::ops::CommandLine as clap::CommandFactory>::command()).unwrap();
        let render = page.split(".SH \"PLICA RENDER\"").nth(1).unwrap();
        let table = render.split(".SS OUTPUTS\n.nf\n").nth(1).unwrap().split(".fi").next().unwrap();
        let plain = table.replace("\\&", "").replace("\\-", "-").replace("\\e", "\\");
        assert!(plain.contains(&crate::export::animation::formats::kept()), "{plain}");
    }
}
