//! Measures a lecture: delay, bytes, frames a second, and the server's processor time, memory and threads. A run that has come
//! to its end is started anew, as a presenter does who shows it again.
//!
//! ```sh
//! cargo run --release -p triad-tests --example lecture -- [FOLLOWERS] [SECONDS] [SCENE]
//! ```

#![allow(clippy::unwrap_used, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a measurement, not a product

use serde_json::json;
use std::time::{Duration, Instant};
use triad_tests::lecture::{FollowerPage, LectureRun, Seen, follow};
use triad_tests::program::Server;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number =
        |at: usize, otherwise: u64| arguments.get(at).map_or(otherwise, |text| text.parse().unwrap());
    let (followers, seconds) = (number(0, 200), number(1, 10));
    let scene = arguments.get(2).map_or("spatial-slider-crank", String::as_str);
    for recording in [true, false] {
        measure(followers, Duration::from_secs(seconds), scene, recording);
    }
}

fn measure(followers: u64, length: Duration, scene: &str, recording: bool) {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    let lecture = LectureRun::open(&server, scene);
    let (start, joined) = (Instant::now(), Instant::now());
    let crowd: Vec<FollowerPage> =
        (0..followers).map(|_| FollowerPage::join(&server.address, &lecture.code, recording)).collect();
    let joining = joined.elapsed();
    let end = Instant::now() + length;
    let watching: Vec<_> = crowd
        .into_iter()
        .map(|follower| std::thread::spawn(move || follow(follower, start, move |_| Instant::now() >= end)))
        .collect();
    let session = format!("/api/v1/sessions/{}", lecture.session);
    server.post(&format!("{session}/play"), &json!({}));
    let (busy, began) = (server.processor_time(), Instant::now());
    let mut runs = 1;
    while Instant::now() + Duration::from_millis(300) < end {
        if server.get(&session).json()["playing"] == false {
            server.post(&format!("{session}/reset"), &json!({}));
            server.post(&format!("{session}/play"), &json!({}));
            runs += 1;
        }
        let view = json!({"view": {"mark": start.elapsed().as_secs_f64()}});
        assert_eq!(lecture.lead(&server, "PUT", "view", &view).status, 204);
        std::thread::sleep(Duration::from_millis(250));
    }
    let busy = server.processor_time().saturating_sub(busy).as_secs_f64();
    let share = busy / began.elapsed().as_secs_f64();
    let (memory, threads) = (server.memory(), server.threads());
    let seen: Vec<Seen> = watching.into_iter().map(|thread| thread.join().unwrap()).collect();
    let told = server.get(&session).json();
    let mut delays: Vec<Duration> = seen.iter().flat_map(|one| one.delays.clone()).collect();
    delays.sort();
    let at = |part: f64| delays[((delays.len() - 1) as f64 * part) as usize].as_secs_f64() * 1e3;
    let mean = |of: fn(&Seen) -> usize| seen.iter().map(of).sum::<usize>() as f64 / seen.len() as f64;
    let wall = length.as_secs_f64();
    println!(
        "{scene}, {followers} followers, {wall} s, {runs} runs, {}",
        if recording { "recordings" } else { "numbers" }
    );
    println!("  joined in              {:.2} s", joining.as_secs_f64());
    println!("  states a second        {:.1}", mean(|one| one.states) / wall);
    println!("  blocks a second        {:.1}", mean(|one| one.blocks) / wall);
    println!("  bytes a second each    {:.0}", mean(|one| one.bytes) / wall);
    println!(
        "  bytes a message        {:.0}",
        mean(|one| one.bytes) / mean(|one| one.states + one.blocks).max(1.0)
    );
    println!(
        "  delay of a mark        {:.1} ms median, {:.1} ms 95 %, {:.1} ms largest",
        at(0.5),
        at(0.95),
        at(1.0)
    );
    println!("  processor time         {busy:.2} s, {:.0} % of one core", 100.0 * share);
    println!("  memory and threads     {memory:.0} MB, {threads:.0}");
    println!("  frames encoded         {} of {}", told["frames_encoded"], told["frames"]);
    server.stop();
}
