//! Versions of the document. A newer one is refused; an older one is brought up to date in memory, one step per
//! version.

use serde_json::Value;

use super::VERSION;
use crate::base::problem::Problem;

/// The function at index i turns a document of version i + 1 into one of version i + 2. Empty while there is one
/// version.
const STEPS: &[fn(&mut Value)] = &[];

/// Brings `json` to [`VERSION`]. JSON that is no object or has no version is left to the check of shape.
pub fn migrate(json: &mut Value) -> Result<(), Problem> {
    let Some(written) = json.get("plica") else { return Ok(()) };
    let Some(version) = written.as_u64().filter(|&version| version >= 1) else {
        return Err(Problem::error("/plica", format!("{written} is no version of the document"))
            .hint(format!("this program writes version {VERSION}")));
    };
    if version > u64::from(VERSION) {
        let message =
            format!("the scene is of version {version}, and this program knows versions up to {VERSION} only");
        return Err(Problem::error("/plica", message).hint("open it with a newer plica"));
    }
    if version < u64::from(VERSION) {
        STEPS.iter().skip(version as usize - 1).for_each(|step| step(json));
        json["plica"] = VERSION.into();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions() {
        for (plica, refused) in [("1", None), ("2", Some("newer")), ("0", Some("writes")), ("\"1\"", Some("writes"))] {
            let mut json = serde_json::from_str(&format!("{{\"plica\": {plica}}}")).unwrap();
            let hint = migrate(&mut json).err().and_then(|problem| problem.hint);
            assert_eq!(hint.is_some(), refused.is_some(), "{plica}");
            assert!(hint.unwrap_or_default().contains(refused.unwrap_or_default()), "{plica}");
        }
        assert_eq!(STEPS.len() as u32 + 1, VERSION);
    }
}
