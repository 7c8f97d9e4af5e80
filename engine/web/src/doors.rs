//! The functions that JavaScript calls. Numbers are offsets into the memory that both see.

use std::cell::RefCell;

use crate::desk::{Desk, Work};

/// What is behind the doors.
#[derive(Default)]
struct Room {
    desk: Desk,
    inbox: Vec<u8>,
    outbox: Vec<u8>,
}

thread_local! {
    // A worker has one thread.
    static ROOM: RefCell<Room> = RefCell::new(Room::default());
}

/// Makes room for a request of `length` bytes, and returns where it is to be written.
#[allow(unsafe_code, reason = "a name for JavaScript")]
#[unsafe(no_mangle)]
pub extern "C" fn inbox(length: usize) -> *mut u8 {
    ROOM.with_borrow_mut(|room| {
        room.inbox.resize(length, 0);
        room.inbox.as_mut_ptr()
    })
}

/// Takes the request in the inbox; `now` is a clock's time in s.
#[allow(unsafe_code, reason = "a name for JavaScript")]
#[unsafe(no_mangle)]
pub extern "C" fn ask(now: f64) {
    ROOM.with_borrow_mut(|room| room.desk.take(&room.inbox, now));
}

/// Does a short spell of work: 0 if there is none, 1 if there is more at once, 2 if there is more at the next tick.
#[allow(unsafe_code, reason = "a name for JavaScript")]
#[unsafe(no_mangle)]
pub extern "C" fn work(now: f64) -> u32 {
    ROOM.with_borrow_mut(|room| match room.desk.work(now) {
        Work::None => 0,
        Work::AtOnce => 1,
        Work::AtTheNextTick => 2,
    })
}

/// Puts the next message into the outbox and returns its length; 0 if there is none.
#[allow(unsafe_code, reason = "a name for JavaScript")]
#[unsafe(no_mangle)]
pub extern "C" fn next() -> usize {
    ROOM.with_borrow_mut(|room| {
        room.outbox = room.desk.next_message().unwrap_or_default();
        room.outbox.len()
    })
}

/// Where the outbox is.
#[allow(unsafe_code, reason = "a name for JavaScript")]
#[unsafe(no_mangle)]
pub extern "C" fn outbox() -> *const u8 {
    ROOM.with_borrow(|room| room.outbox.as_ptr())
}
