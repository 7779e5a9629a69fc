//! The fonts: one of our own, which is always there, and those of the system.

use std::sync::Arc;

use cosmic_text::FontSystem;
use cosmic_text::fontdb::{Database, Source};

/// The name of the window's own font.
pub const OWN: &str = "DejaVu Sans";

/// Fonts, and for whom: the same character is drawn differently in Chinese and Japanese.
pub struct Fonts {
    database: Database,
    locale: String,
}

impl From<Fonts> for FontSystem {
    fn from(fonts: Fonts) -> FontSystem {
        FontSystem::new_with_locale_and_db(fonts.locale, fonts.database)
    }
}

impl std::fmt::Debug for Fonts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} fonts for {}", self.database.len(), self.locale)
    }
}

/// The window's own font alone: Latin, Greek, Cyrillic, Hebrew, Arabic and many signs.
pub fn own() -> Fonts {
    let mut database = Database::new();
    database.load_font_source(Source::Binary(Arc::new(dejavu::sans::regular())));
    database.set_sans_serif_family(OWN);
    let set = |name| std::env::var(name).ok().filter(|value: &String| !value.is_empty());
    let language = set("LC_ALL").or_else(|| set("LC_CTYPE")).or_else(|| set("LANG"));
    Fonts { database, locale: locale(language.as_deref().unwrap_or_default()) }
}

/// All fonts of the system too. Scans all font files.
pub fn of_system() -> Fonts {
    let mut fonts = own();
    fonts.database.load_system_fonts();
    fonts
}

/// `ja_JP.UTF-8` as `ja-JP`.
fn locale(language: &str) -> String {
    let name = language.split(['.', '@']).next().unwrap_or_default().replace('_', "-");
    if name.len() < 2 || name == "POSIX" { "en".into() } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_own_font_is_what_it_is_called() {
        assert!(own().database.faces().any(|face| face.families.iter().any(|(name, _)| name == OWN)));
        assert!(format!("{:?}", own()).starts_with("1 fonts"));
    }

    #[test]
    fn languages_of_the_environment() {
        for (language, expected) in [
            ("ja_JP.UTF-8", "ja-JP"),
            ("de_DE@euro", "de-DE"),
            ("C", "en"),
            ("C.UTF-8", "en"),
            ("POSIX", "en"),
            ("", "en"),
        ] {
            assert_eq!(locale(language), expected, "{language}");
        }
    }
}
