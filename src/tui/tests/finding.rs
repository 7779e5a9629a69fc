//! Tests of moving and finding: (scene, keys, place).

use super::support::state;
use crate::tui::sheet::Sheet;

#[test]
fn a_row_is_the_same_wherever_it_is_looked_at_from() {
    let state = state();
    let zone = "/layers/0/zones/0";
    for node in ["", "/images", "/timeline", zone, &format!("{zone}/outline"), &format!("{zone}/motion"), "/nowhere"] {
        let sheet = Sheet::of(state.document(), node);
        let rows = sheet.rows(0..usize::MAX);
        assert_eq!(rows.len(), sheet.len(), "{node}");
        for (i, row) in rows.iter().enumerate() {
            assert_eq!(sheet.row(i).as_ref(), Some(row));
            assert_eq!(sheet.pointer(i).as_ref(), Some(&row.pointer));
            assert_eq!(sheet.position(&row.pointer), Some(i));
        }
        assert_eq!((sheet.row(rows.len()), sheet.pointer(rows.len())), (None, None));
    }
}
