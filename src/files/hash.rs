//! Hashes of contents and names, in hexadecimal.

use std::fs::File;
use std::io::{Read, Seek};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::base::text::hex;

/// SHA-256 of `bytes`.
pub fn of(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

/// What is in a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contents {
    /// SHA-256 of all its bytes, in hexadecimal.
    pub hash: String,
    /// The number of bytes.
    pub bytes: u64,
}

/// The contents of a file.
pub(super) fn contents(file: &mut File) -> std::io::Result<Contents> {
    file.rewind()?;
    let (mut hash, mut bytes, mut buffer) = (Sha256::new(), 0, vec![0; 64 << 10]);
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(Contents { hash: hex(&hash.finalize()), bytes }),
            n => {
                hash.update(&buffer[..n]);
                bytes += n as u64;
            }
        }
    }
}
