//! Draws the first table of results of `tests/peers/README.md`: run time against error beside other programs.
//!
//! `cargo run --release -p triad-lab --example beside` writes `docs/beside.svg`. The numbers are those of the table, with the
//! machine and the versions that stand above it; nothing is measured here.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;

use triad_plot::{Axis, COLOURS, PlotFrame, Style, escaped};

/// Where the table is, from the root.
const TABLE: &str = "tests/peers/README.md";
/// Where the picture goes.
const PICTURE: &str = "docs/beside.svg";
/// The problems that are drawn, and what they are called.
const PROBLEMS: [(&str, &str); 2] = [
    ("chain-10", "10 rods on ball joints, 2 s"),
    ("four-bar-2", "two four-bars through ten singular positions, 10 s"),
];
/// Width and height of a panel, px; left, right, top and bottom margin.
const PANEL: (f64, f64) = (420.0, 300.0);
const MARGINS: [f64; 4] = [64.0, 20.0, 34.0, 46.0];
/// Height of the legend above the panels, px.
const LEGEND: f64 = 30.0;

/// A row of the table: the problem, the error, and what each program took, ms.
struct Row {
    problem: String,
    error: f64,
    times: Vec<Option<f64>>,
}

/// The programs and the rows of the first table that has errors in its second column.
fn read(text: &str) -> Result<(Vec<String>, Vec<Row>), Box<dyn Error>> {
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let mut lines = text.lines().skip_while(|line| !line.starts_with("| problem | error, m |"));
    let head = cells(lines.next().ok_or("no table of results")?);
    let mut rows = Vec::new();
    for line in lines.skip(1).take_while(|line| line.starts_with('|')) {
        let row = cells(line);
        let times = row[2..].iter().map(|cell| cell.split_once(" ms").and_then(|(ms, _)| ms.parse().ok()));
        rows.push(Row { problem: row[0].clone(), error: row[1].parse()?, times: times.collect() });
    }
    Ok((head[2..].to_vec(), rows))
}

/// The panel of one problem.
fn panel(rows: &[&Row], programs: usize, title: &str, x: &Axis) -> String {
    let y = Axis::around(rows.iter().map(|row| row.error), |exponent| format!("1e{exponent} m")).reversed();
    let frame = PlotFrame { size: PANEL, margins: MARGINS, x: x.clone(), y, grid: "#8886" };
    let mut out = format!(
        "<text x=\"{}\" y=\"20\" font-weight=\"bold\" fill=\"currentColor\">{}</text>\n",
        MARGINS[0],
        escaped(title)
    );
    frame.axes(&mut out);
    let _ = writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"currentColor\">run time, ms</text>",
        0.5 * (MARGINS[0] + PANEL.0 - MARGINS[1]),
        PANEL.1 - 10.0
    );
    for program in 0..programs {
        let reached = rows.iter().filter_map(|row| Some((row.times[program]?, row.error)));
        frame.curve(&mut out, &style(program), &reached.collect::<Vec<_>>(), 4.0);
    }
    out
}

/// The first program, Triad, stands out.
fn style(program: usize) -> Style {
    Style { colour: COLOURS[program], width: if program == 0 { 3.5 } else { 2.0 }, ..Style::number(program) }
}

fn main() -> Result<(), Box<dyn Error>> {
    let (programs, rows) = read(&fs::read_to_string(TABLE)?)?;
    let drawn = |row: &&Row| PROBLEMS.iter().any(|(problem, _)| row.problem == *problem);
    let times = rows.iter().filter(drawn).flat_map(|row| row.times.iter().flatten().copied());
    let x = Axis::around(times, |exponent| format!("{}", libm::pow(10.0, exponent)));
    let (width, height) = (PANEL.0 * PROBLEMS.len() as f64, PANEL.1 + LEGEND);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         role=\"img\" aria-label=\"Run time against error of {}\" font-family=\"system-ui, sans-serif\" font-size=\"12\" \
         class=\"ink\">\n<style>.paper{{fill:#fff}}.ink{{color:#1d2733}}@media(prefers-color-scheme:dark){{.paper{{fill:#10161d}}\
         .ink{{color:#dbe3ea}}polyline,circle,.key{{filter:brightness(1.6)}}}}</style>\n\
         <rect class=\"paper\" width=\"{width}\" height=\"{height}\" rx=\"10\"/>\n",
        programs.join(", ")
    );
    for (index, program) in programs.iter().enumerate() {
        let x = MARGINS[0] + 130.0 * index as f64;
        let Style { colour, width, .. } = style(index);
        let _ = writeln!(
            out,
            "<path class=\"key\" d=\"M{x} 18h24\" stroke=\"{colour}\" stroke-width=\"{width}\"/><text x=\"{}\" y=\"22\" \
             fill=\"currentColor\">{}</text>",
            x + 30.0,
            escaped(program)
        );
    }
    for (index, (problem, title)) in PROBLEMS.iter().enumerate() {
        let own: Vec<&Row> = rows.iter().filter(|row| row.problem == *problem).collect();
        let _ = writeln!(out, "<g transform=\"translate({} {LEGEND})\">", PANEL.0 * index as f64);
        out.push_str(&panel(&own, programs.len(), title, &x));
        out.push_str("</g>\n");
    }
    out.push_str("</svg>\n");
    fs::write(PICTURE, out)?;
    println!("{PICTURE}");
    Ok(())
}
