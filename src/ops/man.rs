//! `plica man`: the manual of the command line as one page, every subcommand in it.

use std::io;

use clap::CommandFactory;
use clap_mangen::Man;

use super::Context;
use super::command_line::CommandLine;
use crate::base::error::{Error, Result};

/// Print the manual
#[derive(clap::Args)]
pub struct Args {}

/// Prints the manual in roff, for `man -l -`.
pub fn run(_: Args, context: &mut Context) -> Result<()> {
    let text = page().map_err(|e| Error::at("the manual", e))?;
    context.print(text.trim_end())
}

fn page() -> io::Result<String> {
    let mut command = CommandLine::command();
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
    fn the_manual_has_the_table_of_outputs() {
        let page = page().unwrap();
        let render = page.split(".SH \"PLICA RENDER\"").nth(1).unwrap();
        let table = render.split(".SS OUTPUTS\n.nf\n").nth(1).unwrap().split(".fi").next().unwrap();
        let plain = table.replace("\\&", "").replace("\\-", "-").replace("\\e", "\\");
        assert!(plain.contains(&crate::export::animation::formats::kept()), "{plain}");
    }
}
