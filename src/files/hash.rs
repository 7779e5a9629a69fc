//! Hashes of contents and names, in hexadecimal.

use sha2::{Digest, Sha256};

/// SHA-256 of `bytes`.
pub fn of(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
