//! Secrets and codes, from the system's source of randomness.

use super::error::StoreError;

/// Letters of a join code: no vowels, so no words; nothing that looks like another letter or digit.
const LETTERS: &[u8; 16] = b"bcdfghjkmpqrtvwx";
/// Length of a join code: 16^8 are 4e9, of which a guesser tries some thousands.
const CODE_LENGTH: usize = 8;

/// Random bytes.
///
/// Errors if the system has none.
pub(super) fn bytes<const N: usize>() -> Result<[u8; N], StoreError> {
    let mut bytes = [0; N];
    let filled = getrandom::fill(&mut bytes);
    filled.map_err(|cause| StoreError::Sql(format!("the system gives no random numbers: {cause}")))?;
    Ok(bytes)
}

/// A secret of 256 bits, hexadecimal.
pub(super) fn token() -> Result<String, StoreError> {
    Ok(super::hash::hexadecimal(&bytes::<32>()?))
}

/// A code for the board.
pub(super) fn join_code() -> Result<String, StoreError> {
    let letters = bytes::<CODE_LENGTH>()?.map(|byte| char::from(LETTERS[usize::from(byte & 15)]));
    Ok(letters.iter().collect())
}
