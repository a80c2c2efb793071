//! Sealed: plain data in a file that is known again: by what program and version it
//! was written, and that nothing of it is missing or changed.
//!
//! Sixteen bytes of magic and version, the length of what follows and its XXH3-64, both
//! in eight bytes with the least significant first, and the data as `postcard` has it.

use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;
use xxhash_rust::xxh3::xxh3_64;

/// What a sealed file begins with. The ends of lines show what a transfer as text does.
const MAGIC: [u8; 12] = *b"carom\r\n\x1a\x00\x00\x00\x00";

/// The version of what is written.
const VERSION: u32 = 7;

/// Bytes before the data.
const HEAD: usize = 32;

/// Why a file cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Unsealed {
    /// It is something else.
    #[error("is no snapshot of carom")]
    Foreign,
    /// It is of a later version of the program.
    #[error("is a snapshot of version {0}; this program reads version {VERSION}")]
    Newer(u32),
    /// It ends too early.
    #[error("is cut off: it has {has} bytes of {of}")]
    CutOff {
        /// How many it has.
        has: u64,
        /// How many it should have.
        of: u64,
    },
    /// Its bytes are not those that were written.
    #[error("is damaged: its checksum does not fit")]
    Damaged,
    /// It holds other data.
    #[error("cannot be understood, though it is whole: it was written by another build")]
    Other,
}

/// Seals data.
///
/// # Errors
/// If it cannot be written as bytes, as a sentence.
pub fn sealed<V: Serialize>(value: &V) -> Result<Vec<u8>, String> {
    let mut bytes = vec![0; HEAD];
    bytes[..12].copy_from_slice(&MAGIC);
    bytes[12..16].copy_from_slice(&VERSION.to_le_bytes());
    let mut bytes = postcard::to_extend(value, bytes).map_err(|error| error.to_string())?;
    let (length, hash) = ((bytes.len() - HEAD) as u64, xxh3_64(&bytes[HEAD..]));
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    bytes[24..32].copy_from_slice(&hash.to_le_bytes());
    Ok(bytes)
}

/// Reads sealed data.
///
/// # Errors
/// If the bytes are not what [`sealed`] has made of such data.
pub fn unsealed<V: DeserializeOwned>(bytes: &[u8]) -> Result<V, Unsealed> {
    let known = bytes.len().min(MAGIC.len());
    if bytes.is_empty() || bytes[..known] != MAGIC[..known] {
        return Err(Unsealed::Foreign);
    }
    let has = bytes.len() as u64;
    let Some((head, data)) = bytes.split_at_checked(HEAD) else {
        return Err(Unsealed::CutOff { has, of: HEAD as u64 });
    };
    let number = |at: usize, len: usize| {
        head[at..at + len].iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte))
    };
    let (version, length, hash) = (number(12, 4) as u32, number(16, 8), number(24, 8));
    if version != VERSION {
        return Err(Unsealed::Newer(version));
    }
    if (data.len() as u64) < length {
        return Err(Unsealed::CutOff { has, of: length.saturating_add(HEAD as u64) });
    }
    if data.len() as u64 != length || xxh3_64(data) != hash {
        return Err(Unsealed::Damaged);
    }
    postcard::from_bytes(data).map_err(|_| Unsealed::Other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_is_told_apart() {
        let value = ("scene".to_owned(), vec![1.5_f64, -0.0], 7_u64);
        let bytes = sealed(&value).unwrap();
        type Value = (String, Vec<f64>, u64);
        assert_eq!(unsealed::<Value>(&bytes), Ok(value));
        assert_eq!(unsealed::<Value>(b""), Err(Unsealed::Foreign));
        assert_eq!(unsealed::<Value>(b"id,x,y,z\n"), Err(Unsealed::Foreign));
        for len in 1..bytes.len() {
            let cut = unsealed::<Value>(&bytes[..len]);
            assert!(matches!(cut, Err(Unsealed::CutOff { .. })), "{len}: {cut:?}");
        }
        for at in HEAD..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x10;
            assert_eq!(unsealed::<Value>(&damaged), Err(Unsealed::Damaged));
        }
        let mut newer = bytes.clone();
        newer[12] = 9;
        assert_eq!(unsealed::<Value>(&newer), Err(Unsealed::Newer(9)));
        assert_eq!(unsealed::<Vec<String>>(&bytes), Err(Unsealed::Other));
    }
}
