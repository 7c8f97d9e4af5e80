//! Runs a built-in scene as often as is asked, on this machine, for a comparison with `tests/browser/pace.mjs`, which lets
//! WebAssembly do the same: `cargo build --release -p triad-web --example pace`, then
//! `time target/release/examples/pace spatial-chain:100 2 20`. Processor time of the whole process is to be compared.

use triad_web::desk::Desk;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [name, until, rounds] = &words[..] else {
        eprintln!("pace SCENE UNTIL ROUNDS");
        return;
    };
    let mut desk = Desk::default();
    let mut ask = |request: String| {
        desk.take(request.as_bytes(), 0.0);
        let message = desk.next_message().unwrap_or_default();
        String::from_utf8_lossy(&message)
            .split_once('\n')
            .map_or_else(String::new, |(_, body)| body.to_owned())
    };
    let scene = ask(format!(r#"{{"id":1,"method":"GET","path":"/scenes/{name}"}}"#));
    let body = format!(r#"{{"scene":{scene},"overrides":{{"duration":{until}}}}}"#);
    let mut steps = String::new();
    for _ in 0..rounds.parse().unwrap_or(1) {
        steps = ask(format!(r#"{{"id":2,"method":"POST","path":"/steps","body":{body}}}"#));
    }
    println!("{name} to {until} s, {rounds} times: {steps} steps each");
}
