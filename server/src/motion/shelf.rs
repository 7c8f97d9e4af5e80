//! Motions that were asked for, kept packed: each is computed once however many look.

use std::collections::HashMap;
use std::io::{Read, Write};
use std::sync::{Mutex, PoisonError};

use axum::body::Bytes;
use flate2::Compression;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use serde::Serialize;
use triad_engine::analysis::Wanted;

use crate::problem::Problem;
use crate::work::Work;

/// Motions that are kept: those of a course and of all built-in scenes; when there are more, all are dropped.
const KEPT: usize = 128;

/// The motions that were asked for.
#[derive(Debug, Default)]
pub struct Shelf {
    kept: Mutex<HashMap<String, Bytes>>,
    /// One is made at a time: who asks for the same waits and finds it, or makes it where the one before has left.
    making: tokio::sync::Mutex<()>,
}

impl Shelf {
    /// The JSON of what `make` gives, packed by gzip: kept under a name, or made when its turn comes.
    ///
    /// Errors as `make` and [`Work::run`] do; nothing is kept then.
    pub async fn of<T: Serialize>(
        &self,
        name: &str,
        work: &Work,
        make: impl FnOnce(&Wanted) -> Result<T, Problem> + Send + 'static,
    ) -> Result<Bytes, Problem> {
        if let Some(found) = self.find(name) {
            return Ok(found);
        }
        let _alone = self.making.lock().await;
        if let Some(found) = self.find(name) {
            return Ok(found);
        }
        let made = work.run(move |wanted| packed(&make(wanted)?)).await?;
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() >= KEPT {
            kept.clear();
        }
        kept.insert(name.to_owned(), made.clone());
        Ok(made)
    }

    fn find(&self, name: &str) -> Option<Bytes> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).get(name).cloned()
    }
}

fn packed(value: &impl Serialize) -> Result<Bytes, Problem> {
    let text = serde_json::to_vec(value).map_err(Problem::internal)?;
    let mut packer = GzEncoder::new(Vec::new(), Compression::best());
    packer.write_all(&text).map_err(Problem::internal)?;
    Ok(packer.finish().map_err(Problem::internal)?.into())
}

/// For those who do not read gzip.
pub fn unpacked(packed: &Bytes) -> Result<Bytes, Problem> {
    let mut text = Vec::new();
    GzDecoder::new(packed.as_ref()).read_to_end(&mut text).map_err(Problem::internal)?;
    Ok(text.into())
}
