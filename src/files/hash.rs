//! Hashes of contents and names, in hexadecimal.

use sha2::{Digest, Sha256};

use crate::base::text::hex;

/// SHA-256 of `bytes`.
pub fn of(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}
