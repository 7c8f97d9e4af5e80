//! What was measured, as a table for the terminal, as CSV and as a page.

use std::fmt::Write as _;

use super::measure::Measured;
use super::plot;

/// The scenes in the order in which they were measured, each with its runs.
fn by_scene(runs: &[Measured]) -> Vec<(&'static str, Vec<&Measured>)> {
    let mut scenes: Vec<(&'static str, Vec<&Measured>)> = Vec::new();
    for run in runs {
        match scenes.iter_mut().find(|(scene, _)| *scene == run.scene) {
            Some((_, list)) => list.push(run),
            None => scenes.push((run.scene, vec![run])),
        }
    }
    scenes
}

/// Times in ms at which an error is reached, interpolated between runs on logarithmic axes, or `None`.
fn time_to(runs: &[&Measured], error: f64) -> Option<f64> {
    let points: Vec<(f64, f64)> =
        runs.iter().filter_map(|r| Some((r.error?.max(1e-15), r.median()))).collect();
    let direct = points.iter().filter(|p| p.0 <= error).map(|p| p.1).fold(f64::INFINITY, f64::min);
    let between = points.windows(2).filter(|w| w[0].0 > error && w[1].0 <= error).map(|w| {
        let part = (error / w[0].0).ln() / (w[1].0 / w[0].0).ln();
        (w[0].1.ln() + part * (w[1].1 / w[0].1).ln()).exp()
    });
    let best = between.fold(direct, f64::min);
    best.is_finite().then_some(best * 1e3)
}

/// Time to reach each of three errors, for the terminal.
pub fn table(runs: &[Measured]) -> String {
    let mut out = format!("{:<26}{:<10}{:>12}{:>12}{:>12}\n", "scene", "integrator", "1e-3", "1e-6", "1e-9");
    for (scene, runs) in by_scene(runs) {
        let mut kinds = Vec::new();
        for run in &runs {
            if !kinds.contains(&run.integrator) {
                kinds.push(run.integrator);
            }
        }
        for kind in kinds {
            let own: Vec<&Measured> = runs.iter().copied().filter(|r| r.integrator == kind).collect();
            let _ = write!(out, "{scene:<26}{:<10}", plot::name(kind));
            for error in [1e-3, 1e-6, 1e-9] {
                let cell = time_to(&own, error).map_or_else(|| "–".to_owned(), |t| format!("{t:.3} ms"));
                let _ = write!(out, "{cell:>12}");
            }
            out.push('\n');
        }
    }
    out
}

/// All runs, one a line.
pub fn csv(runs: &[Measured]) -> String {
    let mut out = String::from(
        "scene,integrator,tolerance,error_m,median_s,least_s,spread,repeats,steps,rejected,evaluations,\
         factorizations,solves\n",
    );
    for run in runs {
        let work = &run.work;
        let _ = writeln!(
            out,
            "{},{},{:e},{},{:.9},{:.9},{:.3},{},{},{},{},{},{}",
            run.scene,
            plot::name(run.integrator),
            run.tolerance,
            run.error.map_or_else(String::new, |e| format!("{e:.3e}")),
            run.median(),
            run.times.first().copied().unwrap_or(f64::NAN),
            run.spread(),
            run.times.len(),
            work.steps,
            work.rejected,
            work.evaluations,
            work.factorizations,
            work.solves
        );
    }
    out
}

/// The plots and the table as a page that stands alone.
pub fn html(runs: &[Measured]) -> String {
    let mut out = String::from(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Triad: run time against error</title>\n\
         <style>body{font:15px/1.5 sans-serif;max-width:72rem;margin:2rem auto;padding:0 1rem}\
         .plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(26rem,1fr));gap:1rem}\
         table{border-collapse:collapse}td,th{padding:.2rem .7rem;text-align:right;border-bottom:1px solid #ddd}\
         td:first-child,th:first-child,td:nth-child(2),th:nth-child(2){text-align:left}</style>\n\
         <h1>Run time against error</h1>\n<p>Integration alone, one thread, medians of interleaved repeats. The error \
         is the largest distance from the reference over samples every 0.01 s.</p>\n<div class=\"plots\">\n",
    );
    for (scene, runs) in by_scene(runs) {
        out.push_str(&plot::svg(scene, &runs));
    }
    out.push_str(
        "</div>\n<h2>All runs</h2>\n<table><tr><th>scene<th>integrator<th>tolerance<th>error, m<th>median, ms\
         <th>spread<th>steps<th>factorizations<th>solves</tr>\n",
    );
    for run in runs {
        let _ = writeln!(
            out,
            "<tr><td>{}<td>{}<td>{:.0e}<td>{}<td>{:.3}<td>{:.0} %<td>{}<td>{}<td>{}</tr>",
            run.scene,
            plot::name(run.integrator),
            run.tolerance,
            run.error.map_or_else(|| "stopped".to_owned(), |e| format!("{e:.1e}")),
            run.median() * 1e3,
            run.spread() * 100.0,
            run.work.steps,
            run.work.factorizations,
            run.work.solves
        );
    }
    out.push_str("</table>\n</html>\n");
    out
}
