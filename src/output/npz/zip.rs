//! A ZIP archive of entries that are stored as they are, of any size.
//!
//! PKWARE's APPNOTE 6.3: local headers, a central directory, and the ZIP64 form of both
//! where a size or an offset has more than 32 bits.

use std::io::{self, Read, Write};

/// An archive under way.
#[derive(Debug)]
pub struct Archive<W> {
    output: W,
    directory: Vec<u8>,
    offset: u64,
    entries: u64,
}

/// What stands where a number has more than 32 bits.
const FULL: u32 = u32::MAX;

/// The version that knows ZIP64.
const VERSION: u16 = 45;

/// The first of January 1980: an archive tells nothing of when it was made.
const DATE: u16 = 1 << 5 | 1;

impl<W: Write> Archive<W> {
    pub fn new(output: W) -> Self {
        Self { output, directory: Vec::new(), offset: 0, entries: 0 }
    }

    /// Adds an entry of a size and checksum.
    pub fn add(&mut self, name: &str, size: u64, crc: u32, data: &mut dyn Read) -> io::Result<()> {
        let mut local = Vec::new();
        local.extend_from_slice(b"PK\x03\x04");
        common(&mut local, crc, name.len(), 20);
        local.extend_from_slice(name.as_bytes());
        extra(&mut local, &[size, size]);

        let central = &mut self.directory;
        central.extend_from_slice(b"PK\x01\x02");
        central.extend_from_slice(&VERSION.to_le_bytes());
        common(central, crc, name.len(), 28);
        // No comment, disk 0, no attributes.
        central.extend_from_slice(&[0; 10]);
        central.extend_from_slice(&FULL.to_le_bytes());
        central.extend_from_slice(name.as_bytes());
        extra(central, &[size, size, self.offset]);

        self.output.write_all(&local)?;
        self.copy(size, data)?;
        self.offset += local.len() as u64 + size;
        self.entries += 1;
        Ok(())
    }

    /// Copies the bytes of an entry, in pieces large enough to cost few calls.
    fn copy(&mut self, size: u64, data: &mut dyn Read) -> io::Result<()> {
        let mut buffer = vec![0; 1 << 18];
        let mut left = size;
        while left > 0 {
            let most = left.min(buffer.len() as u64) as usize;
            let count = data.read(&mut buffer[..most])?;
            if count == 0 {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            self.output.write_all(&buffer[..count])?;
            left -= count as u64;
        }
        Ok(())
    }

    /// Writes the directory.
    pub fn finish(mut self) -> io::Result<W> {
        let (start, length) = (self.offset, self.directory.len() as u64);
        let mut end = self.directory;
        end.extend_from_slice(b"PK\x06\x06");
        end.extend_from_slice(&44_u64.to_le_bytes());
        end.extend_from_slice(&VERSION.to_le_bytes());
        end.extend_from_slice(&VERSION.to_le_bytes());
        end.extend_from_slice(&[0; 8]);
        for value in [self.entries, self.entries, length, start] {
            end.extend_from_slice(&value.to_le_bytes());
        }
        end.extend_from_slice(b"PK\x06\x07\0\0\0\0");
        end.extend_from_slice(&(start + length).to_le_bytes());
        end.extend_from_slice(&1_u32.to_le_bytes());
        end.extend_from_slice(b"PK\x05\x06");
        // All numbers stand in the record before.
        end.extend_from_slice(&[0, 0, 0, 0]);
        end.extend_from_slice(&[0xff; 12]);
        end.extend_from_slice(&[0, 0]);
        self.output.write_all(&end)?;
        self.output.flush()?;
        Ok(self.output)
    }
}

/// What both headers of an entry have: stored, sizes in the extra field.
fn common(header: &mut Vec<u8>, crc: u32, name: usize, extra: u16) {
    header.extend_from_slice(&VERSION.to_le_bytes());
    header.extend_from_slice(&[0; 4]);
    header.extend_from_slice(&[0; 2]);
    header.extend_from_slice(&DATE.to_le_bytes());
    header.extend_from_slice(&crc.to_le_bytes());
    header.extend_from_slice(&FULL.to_le_bytes());
    header.extend_from_slice(&FULL.to_le_bytes());
    header.extend_from_slice(&(name as u16).to_le_bytes());
    header.extend_from_slice(&extra.to_le_bytes());
}

/// The extra field of ZIP64.
fn extra(header: &mut Vec<u8>, values: &[u64]) {
    header.extend_from_slice(&1_u16.to_le_bytes());
    header.extend_from_slice(&(8 * values.len() as u16).to_le_bytes());
    for value in values {
        header.extend_from_slice(&value.to_le_bytes());
    }
}
