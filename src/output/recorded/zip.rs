//! The directory of a ZIP archive, whose entries are stored as they are (PKWARE's APPNOTE
//! 6.3, with ZIP64).

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

use crc32fast::Hasher;

use super::{FramePlace, Wrong};
use crate::numbers::array::Each;

/// An entry of an archive.
#[derive(Clone, Debug)]
pub struct Entry {
    pub name: String,
    /// Where its data begins.
    pub start: u64,
    pub size: u64,
}

/// What stands where a number has more than 32 bits.
const FULL: u64 = u32::MAX as u64;

/// Bytes of the end of a directory without a comment, and of the longest comment.
const END: u64 = 22;
const COMMENT: u64 = u16::MAX as u64;

fn number(bytes: &[u8], at: usize, size: usize) -> Option<u64> {
    let bytes = bytes.get(at..at + size)?;
    Some(bytes.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte)))
}

/// Bytes of a file.
pub fn bytes_at(mut file: &File, start: u64, size: u64) -> Result<Vec<u8>, Wrong> {
    let place = FramePlace::Byte(start);
    let mut read = || -> io::Result<Vec<u8>> {
        file.seek(SeekFrom::Start(start))?;
        let mut bytes = Vec::new();
        file.take(size).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let bytes = read().map_err(|error| Wrong::unreadable(place, &error))?;
    if bytes.len() as u64 == size {
        return Ok(bytes);
    }
    Err(Wrong::new(place, format!("the file ends within {size} bytes from here; it is cut off")))
}

/// The entries of an archive, each with the checksum that it should have.
pub fn entries(file: &mut File) -> Result<Vec<Entry>, Wrong> {
    let length =
        file.metadata().map_err(|error| Wrong::unreadable(FramePlace::File, &error))?.len();
    let tail_start = length.saturating_sub(END + COMMENT);
    let tail = bytes_at(file, tail_start, length - tail_start)?;
    let end = (0..tail.len().saturating_sub(END as usize - 1))
        .rev()
        .find(|at| tail[*at..].starts_with(b"PK\x05\x06"))
        .ok_or_else(|| {
            let problem = "is no whole archive of NumPy: its directory, at the end, is missing";
            Wrong::new(FramePlace::File, problem)
        })?;
    let broken = |at: u64| Wrong::new(FramePlace::Byte(at), "the archive's directory is damaged");
    let at_end = tail_start + end as u64;
    let mut count = number(&tail, end + 10, 2);
    let mut size = number(&tail, end + 12, 4);
    let mut start = number(&tail, end + 16, 4);
    let locator = end.checked_sub(20).filter(|at| tail[*at..].starts_with(b"PK\x06\x07"));
    if let Some(locator) = locator {
        let far = number(&tail, locator + 8, 8).ok_or_else(|| broken(at_end))?;
        let record = bytes_at(file, far, 56)?;
        if !record.starts_with(b"PK\x06\x06") {
            return Err(broken(far));
        }
        count = number(&record, 32, 8);
        size = number(&record, 40, 8);
        start = number(&record, 48, 8);
    }
    let (Some(count), Some(size), Some(start)) = (count, size, start) else {
        return Err(broken(at_end));
    };
    if size > length || count > size {
        return Err(broken(at_end));
    }
    let directory = bytes_at(file, start, size)?;
    let mut at = 0;
    let mut entries = Vec::new();
    for _ in 0..count {
        let here = || broken(start + at as u64);
        if !directory.get(at..).is_some_and(|rest| rest.starts_with(b"PK\x01\x02")) {
            return Err(here());
        }
        let field = |offset, size| number(&directory, at + offset, size).ok_or_else(here);
        let (method, crc) = (field(10, 2)?, field(16, 4)?);
        let (packed, mut size, mut local) = (field(20, 4)?, field(24, 4)?, field(42, 4)?);
        let [name, extra, comment] =
            [field(28, 2)?, field(30, 2)?, field(32, 2)?].each(|it| it as usize);
        let own = directory.get(at + 46..at + 46 + name).ok_or_else(here)?;
        let own = String::from_utf8_lossy(own).into_owned();
        // In the order of the fields that are full.
        let mut wide = wide(&directory, at + 46 + name, extra).into_iter();
        let mut wider = |short: u64| if short == FULL { wide.next() } else { Some(short) };
        size = wider(size).ok_or_else(here)?;
        let packed = wider(packed).ok_or_else(here)?;
        local = wider(local).ok_or_else(here)?;
        if method != 0 || packed != size {
            let problem = format!("{own} is compressed; save the arrays with numpy.savez");
            return Err(Wrong::new(FramePlace::Byte(local), problem));
        }
        let header = bytes_at(file, local, 30)?;
        if !header.starts_with(b"PK\x03\x04") {
            return Err(broken(local));
        }
        let skipped = number(&header, 26, 2).zip(number(&header, 28, 2));
        let (name_length, extra_length) = skipped.ok_or_else(|| broken(local))?;
        let begins = local + 30 + name_length + extra_length;
        if begins.checked_add(size).is_none_or(|end| end > length) {
            return Err(broken(local));
        }
        check(file, begins, size, crc, &own)?;
        entries.push(Entry { name: own, start: begins, size });
        at += 46 + name + extra + comment;
    }
    Ok(entries)
}

/// The numbers of 64 bits in an extra field.
fn wide(directory: &[u8], start: usize, length: usize) -> Vec<u64> {
    let mut at = start;
    while at + 4 <= start + length {
        let (Some(kind), Some(size)) = (number(directory, at, 2), number(directory, at + 2, 2))
        else {
            break;
        };
        if kind == 1 {
            let count = size as usize / 8;
            return (0..count).filter_map(|k| number(directory, at + 4 + 8 * k, 8)).collect();
        }
        at += 4 + size as usize;
    }
    Vec::new()
}

/// Whether the bytes of an entry are those that were written.
fn check(file: &mut File, start: u64, size: u64, crc: u64, name: &str) -> Result<(), Wrong> {
    const PIECE: u64 = 1 << 18;
    let mut hasher = Hasher::new();
    let mut at = 0;
    while at < size {
        let piece = bytes_at(file, start + at, PIECE.min(size - at))?;
        hasher.update(&piece);
        at += piece.len() as u64;
    }
    if u64::from(hasher.finalize()) == crc {
        return Ok(());
    }
    let problem = format!("{name} is damaged: the checksum of its {size} bytes does not fit");
    Err(Wrong::new(FramePlace::Byte(start), problem))
}
