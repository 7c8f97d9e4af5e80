//! Four words with which somebody comes back, and their hash.

use argon2::Argon2;
use argon2::password_hash::{PasswordHash, PasswordHasher, PasswordVerifier, SaltString};
use tokio::sync::Semaphore;

use crate::blocking;
use crate::problem::Problem;

/// Words, 512 of them, none the beginning of another: four are 36 bits, of which a guesser tries one a minute.
const WORDS: &str = include_str!("words.txt");
/// How many words one comes back with.
const COUNT: usize = 4;

/// Longest phrase that is looked at, in bytes: four words and whatever stands between them.
const LONGEST: usize = 200;
/// Hashes that are computed at a time. Each takes 19 MB: of a hall that joins at once, or of somebody who guesses, the others wait.
const AT_ONCE: usize = 4;
static PLACES: Semaphore = Semaphore::const_new(AT_ONCE);

/// The hash of words that nobody has.
const NOBODY: &str =
    "$argon2id$v=19$m=19456,t=2,p=1$AAAAAAAAAAAAAAAAAAAAAA$AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA";

/// Four words by chance.
///
/// Errors if the system has no randomness.
pub fn generate() -> Result<String, Problem> {
    let words: Vec<&str> = WORDS.split_whitespace().collect();
    let mut bytes = [0; 2 * COUNT];
    getrandom::fill(&mut bytes).map_err(Problem::internal)?;
    // 65536 is a multiple of 512: each word is as likely as any other.
    let word = |pair: &[u8]| words[usize::from(u16::from_le_bytes([pair[0], pair[1]])) % words.len()];
    Ok(bytes.chunks(2).map(word).collect::<Vec<_>>().join(" "))
}

/// The hash that is kept: slow to compute, so that few words stay hard to guess from a stolen file.
///
/// Errors if the system has no randomness.
pub fn hash(phrase: &str) -> Result<String, Problem> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(Problem::internal)?;
    let salt = SaltString::encode_b64(&bytes).map_err(Problem::internal)?;
    let hashed = Argon2::default().hash_password(plain(phrase).as_bytes(), &salt);
    Ok(hashed.map_err(Problem::internal)?.to_string())
}

/// Whether the phrase is the one whose hash is kept. Takes as long where there is none.
pub fn fits(phrase: &str, kept: Option<&str>) -> bool {
    let phrase = if phrase.len() > LONGEST { "" } else { phrase };
    let parsed = PasswordHash::new(kept.unwrap_or(NOBODY));
    parsed.is_ok_and(|kept| Argon2::default().verify_password(plain(phrase).as_bytes(), &kept).is_ok())
}

/// Runs what hashes, when its turn comes, on a thread that may block. It keeps its place until it ends, whoever leaves.
///
/// Errors as `work` does.
pub async fn in_turn<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Problem> + Send + 'static,
) -> Result<T, Problem> {
    let place = PLACES.acquire().await.map_err(Problem::internal)?;
    blocking(move || {
        let _place = place;
        work()
    })
    .await
}

/// As people type it: any case, any number of spaces, commas or dashes between.
fn plain(phrase: &str) -> String {
    let words = phrase.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::sync::mpsc::{Receiver, channel};
    use std::sync::{Arc, Mutex};
    use std::time::Duration;
    use tokio::time::timeout;

    /// Ends a test that hangs, and decides nothing else.
    const HANG: Duration = Duration::from_mins(1);

    #[test]
    fn words_are_many_and_cannot_be_confused() {
        let words: Vec<&str> = WORDS.split_whitespace().collect();
        assert_eq!(words.iter().collect::<BTreeSet<_>>().len(), 512);
        for (a, b) in words.iter().flat_map(|a| words.iter().map(move |b| (a, b))) {
            assert!(a == b || !b.starts_with(a), "{a} {b}");
        }
        let (one, other) = (generate().unwrap(), generate().unwrap());
        assert!(one != other && one.split(' ').count() == COUNT, "{one}, {other}");
    }

    #[test]
    fn a_phrase_fits_as_people_type_it() {
        let kept = hash("otter maple zinc harbor").unwrap();
        assert!(fits(" Otter-maple,  ZINC harbor. ", Some(&kept)));
        assert!(!fits("otter maple zinc", Some(&kept)) && !fits("otter maple zinc harbor", None));
        assert!(PasswordHash::new(NOBODY).is_ok());
        assert_ne!(kept, hash("otter maple zinc harbor").unwrap(), "salted");
    }
    #[test]
    fn a_phrase_of_a_megabyte_is_not_hashed_as_it_is() {
        let kept = hash("otter maple zinc harbor").unwrap();
        let long = "otter maple zinc harbor".to_owned() + &" ".repeat(1 << 20);
        assert!(!fits(&long, Some(&kept)));
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn of_a_hall_that_joins_at_once_few_hashes_are_computed_at_a_time() {
        let (finish, gate) = channel::<()>();
        let gate = Arc::new(Mutex::new(gate));
        let (begin, begun) = channel::<()>();
        let all: Vec<_> = (0..5 * AT_ONCE)
            .map(|_| {
                let (begin, gate): (_, Arc<Mutex<Receiver<()>>>) = (begin.clone(), Arc::clone(&gate));
                tokio::spawn(in_turn(move || {
                    begin.send(()).map_err(Problem::internal)?;
                    gate.lock().unwrap().recv().map_err(Problem::internal)
                }))
            })
            .collect();
        let full = async {
            while PLACES.available_permits() > 0 {
                tokio::task::yield_now().await;
            }
        };
        timeout(HANG, full).await.expect("those who hash take places");
        (0..AT_ONCE).for_each(|_| begun.recv_timeout(HANG).expect("a place is used"));
        assert!(begun.try_recv().is_err(), "no more than {AT_ONCE} compute");
        (0..5 * AT_ONCE).for_each(|_| finish.send(()).expect("they wait"));
        for one in all {
            one.await.expect("ends").expect("its turn comes");
        }
    }
}
