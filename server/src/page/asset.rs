//! The embedded files, and their bytes in the encoding that a caller reads.

use std::io::Read;

use axum::body::Bytes;
use brotli_decompressor::Decompressor;
use flate2::Compression;
use flate2::read::GzEncoder;
use tokio::sync::OnceCell;

use crate::problem::Problem;

/// How much gzip tries, of 9: the viewer's 47 MB become 14.7 MB, and the first browser waits for them (3.2 s measured on two busy
/// cores). With 6 they become 14.5 MB.
const GZIP_LEVEL: u32 = 4;
/// Bytes that the unpacker reads at once.
const CHUNK: usize = 1 << 16;

/// One embedded file.
#[derive(Debug)]
pub(super) struct Asset {
    /// Path below the page's root, without a leading slash.
    pub path: &'static str,
    /// Entity tag, with its quotation marks.
    pub tag: &'static str,
    stored: Stored,
    /// Packed by gzip, once somebody asked for it.
    gzip: OnceCell<Bytes>,
}

/// How a file is kept.
#[derive(Debug, Clone, Copy)]
enum Stored {
    Plain(&'static [u8]),
    Brotli(&'static [u8]),
}

/// A way to pack what is sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Brotli,
    Gzip,
}

impl Encoding {
    /// Its name in HTTP.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Brotli => "br",
            Self::Gzip => "gzip",
        }
    }
}

include!(concat!(env!("OUT_DIR"), "/assets.rs"));

/// The file at a path.
pub(super) fn find(path: &str) -> Option<&'static Asset> {
    ASSETS.binary_search_by(|asset| asset.path.cmp(path)).ok().map(|index| &ASSETS[index])
}

impl Asset {
    const fn new(path: &'static str, tag: &'static str, stored: Stored) -> Self {
        Self { path, tag, stored, gzip: OnceCell::const_new() }
    }

    /// A file that is kept as text.
    pub fn text(&'static self) -> Option<&'static str> {
        match self.stored {
            Stored::Plain(plain) => std::str::from_utf8(plain).ok(),
            Stored::Brotli(_) => None,
        }
    }

    /// The file in the smallest encoding that the caller reads.
    pub async fn bytes(
        &'static self,
        reads: impl Fn(Encoding) -> bool,
    ) -> Result<(Option<Encoding>, Bytes), Problem> {
        let packed = match self.stored {
            Stored::Plain(plain) => return Ok((None, Bytes::from_static(plain))),
            Stored::Brotli(packed) => packed,
        };
        if reads(Encoding::Brotli) {
            return Ok((Some(Encoding::Brotli), Bytes::from_static(packed)));
        }
        if reads(Encoding::Gzip) {
            // A class that opens the page at once waits for one packing.
            let packing =
                || async { read(GzEncoder::new(unpack(packed), Compression::new(GZIP_LEVEL))).await };
            return Ok((Some(Encoding::Gzip), self.gzip.get_or_try_init(packing).await?.clone()));
        }
        Ok((None, read(unpack(packed)).await?))
    }
}

fn unpack(packed: &'static [u8]) -> Decompressor<&'static [u8]> {
    Decompressor::new(packed, CHUNK)
}

/// Reads to the end on a thread that may be busy for a second.
async fn read(mut source: impl Read + Send + 'static) -> Result<Bytes, Problem> {
    let reading = move || {
        let mut bytes = Vec::new();
        source.read_to_end(&mut bytes).map_err(Problem::internal)?;
        Ok(bytes.into())
    };
    crate::blocking(reading).await
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_can_be_found_by_bisection_and_every_one_has_content() {
        assert!(ASSETS.is_sorted_by(|a, b| a.path < b.path));
        assert!(find("index.html").is_some(), "the page is embedded");
        assert!(ASSETS.iter().all(|asset| match asset.stored {
            Stored::Plain(bytes) | Stored::Brotli(bytes) => !bytes.is_empty(),
        }));
    }
}
