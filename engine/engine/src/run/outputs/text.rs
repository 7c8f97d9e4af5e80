//! Rows of a table as text.

/// Room for the longest number and a comma, and the numbers that are put down together.
const LONGEST: usize = 25;
const TOGETHER: usize = 16;
/// The numbers that are put down at once.
const ZERO: u64 = 0.0f64.to_bits();
const ONE: u64 = 1.0f64.to_bits();

/// Appends the numbers of a row, commas between them, and the end of its line: as few digits as give each number back exactly.
///
/// ```
/// let mut text = Vec::new();
/// triad_engine::run::append_row(&mut text, &[0.1, 1.0, -2.5e-30, 0.0]);
/// assert_eq!(text, b"0.1,1,-2.5e-30,0\n");
/// ```
pub fn append_row(text: &mut Vec<u8>, row: &[f64]) {
    let mut digits = zmij::Buffer::new();
    let mut room = [b','; LONGEST * TOGETHER];
    for numbers in row.chunks(TOGETHER) {
        let mut end = 0;
        for number in numbers {
            let room = &mut room[end..];
            let count = match number.to_bits() {
                // What bodies in a plane have many of.
                ZERO => put_one(b'0', room),
                ONE => put_one(b'1', room),
                _ => {
                    let number = digits.format(*number).as_bytes();
                    put(if let [number @ .., b'.', b'0'] = number { number } else { number }, room)
                }
            };
            room[count] = b',';
            end += count + 1;
        }
        text.extend_from_slice(&room[..end]);
    }
    if !row.is_empty() {
        text.pop();
    }
    text.push(b'\n');
}

/// Puts a digit where there is room, and says that it is one.
#[inline(always)]
fn put_one(digit: u8, room: &mut [u8]) -> usize {
    room[0] = digit;
    1
}

/// Puts digits where there is room, and says how many they are. Pieces of known length take no call.
#[inline(always)]
fn put(digits: &[u8], room: &mut [u8]) -> usize {
    let count = digits.len();
    let room = &mut room[..count];
    if let (16..=24, Some(first), Some(last)) = (count, digits.first_chunk::<16>(), digits.last_chunk::<8>())
    {
        room[..16].copy_from_slice(first);
        room[count - 8..].copy_from_slice(last);
    } else if let (8..=16, Some(first), Some(last)) =
        (count, digits.first_chunk::<8>(), digits.last_chunk::<8>())
    {
        room[..8].copy_from_slice(first);
        room[count - 8..].copy_from_slice(last);
    } else {
        room.iter_mut().zip(digits).for_each(|(room, digit)| *room = *digit);
    }
    count
}
