//! What was measured, as a table for the terminal, as CSV and as a page.

use std::fmt::Write as _;

use crate::csv::quoted;

use triad_scene::IntegratorKind;

use super::measure::Measured;
use super::plan::Method;
use super::plot;

/// Errors to be reached, m.
const ERRORS: [f64; 3] = [1e-3, 1e-6, 1e-9];

/// The scenes in the order in which they were measured, each with its runs.
pub fn by_scene(runs: &[Measured]) -> Vec<(&str, Vec<&Measured>)> {
    let mut scenes: Vec<(&str, Vec<&Measured>)> = Vec::new();
    for run in runs {
        match scenes.iter_mut().find(|(scene, _)| *scene == run.scene) {
            Some((_, list)) => list.push(run),
            None => scenes.push((&run.scene, vec![run])),
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
        let part = libm::log(error / w[0].0) / libm::log(w[1].0 / w[0].0);
        libm::exp(libm::log(w[0].1) + part * libm::log(w[1].1 / w[0].1))
    });
    let best = between.fold(direct, f64::min);
    best.is_finite().then_some(best * 1e3)
}

/// Time to reach each of three errors, for the terminal.
pub fn table(runs: &[Measured]) -> String {
    let width = runs.iter().map(|r| r.method.to_string().len()).max().unwrap_or(0).max(10) + 2;
    let mut out =
        format!("{:<26}{:<width$}{:>12}{:>12}{:>12}\n", "scene", "method", "1e-3 m", "1e-6 m", "1e-9 m");
    let mut worst: Option<(f64, String)> = None;
    for (scene, runs) in by_scene(runs) {
        let times: Vec<(Method, [Option<f64>; 3])> = plot::methods(&runs)
            .into_iter()
            .map(|method| {
                let own: Vec<&Measured> = runs.iter().copied().filter(|r| r.method == method).collect();
                (method, ERRORS.map(|error| time_to(&own, error)))
            })
            .collect();
        for (method, times) in &times {
            let _ = write!(out, "{scene:<26}{:<width$}", method.to_string());
            for time in times {
                let cell = time.map_or_else(|| "–".to_owned(), |t| format!("{t:.3} ms"));
                let _ = write!(out, "{cell:>12}");
            }
            out.push('\n');
        }
        for (ratio, what) in slower_than_best(scene, &times) {
            if worst.as_ref().is_none_or(|(most, _)| ratio > *most) {
                worst = Some((ratio, what));
            }
        }
    }
    if let Some((ratio, what)) = worst {
        let _ = writeln!(out, "\nauto takes at most {ratio:.2} times as long as the best choice ({what})");
    }
    out
}

/// How much slower the automatic choice is than the best way to run the same kind of bodies, for each error, with the
/// place in words.
fn slower_than_best(scene: &str, times: &[(Method, [Option<f64>; 3])]) -> Vec<(f64, String)> {
    let auto = times.iter().find(|(method, _)| method.integrator == IntegratorKind::Auto);
    let ratio = |k: usize| {
        let (own, reached) = auto?;
        let alike = times.iter().filter(|(method, _)| method.coordinates == own.coordinates);
        let best = alike.filter_map(|(_, t)| t[k]).fold(f64::INFINITY, f64::min);
        Some((reached[k]? / best, format!("{scene}, {:e}", ERRORS[k])))
    };
    (0..ERRORS.len()).filter_map(ratio).collect()
}

/// All runs, one a line.
pub fn csv(runs: &[Measured]) -> String {
    let mut out = String::from(
        "scene,integrator,treatment,coordinates,tolerance,error_m,median_s,least_s,spread,repeats,steps,rejected,evaluations,\
         factorizations,solves\n",
    );
    for run in runs {
        let work = &run.work;
        let _ = writeln!(
            out,
            "{},{},{},{},{:e},{},{:.9},{:.9},{:.3},{},{},{},{},{},{}",
            quoted(&run.scene),
            run.method.integrator,
            run.method.treatment(),
            run.method.coordinates,
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

/// The plots and the table as a self-contained page.
pub fn html(runs: &[Measured]) -> String {
    let mut out = String::from(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Triad: run time against error</title>\n\
         <style>body{font:15px/1.5 sans-serif;max-width:72rem;margin:2rem auto;padding:0 1rem}\
         .plots svg{width:100%;height:auto}.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(26rem,1fr));gap:1rem}\
         table{border-collapse:collapse}td,th{padding:.2rem .7rem;text-align:right;border-bottom:1px solid #ddd}\
         td:first-child,th:first-child,td:nth-child(2),th:nth-child(2){text-align:left}</style>\n\
         <h1>Run time against error</h1>\n<p>Integration with the estimate of its error, which a run carries along unless its scene leaves it \
         out; one thread, medians of interleaved repeats. The error is the largest distance from the reference over samples every \
         0.01 s, or every hundredth of a run that is shorter than 1 s, and not less than what the reference may be off itself.</p>\n<div class=\"plots\">\n",
    );
    for (scene, runs) in by_scene(runs) {
        out.push_str(&plot::svg(scene, &runs));
    }
    out.push_str(
        "</div>\n<h2>All runs</h2>\n<table><tr><th>scene<th>method<th>tolerance<th>error, m<th>median, ms\
         <th>spread<th>steps<th>factorizations<th>solves</tr>\n",
    );
    for run in runs {
        let _ = writeln!(
            out,
            "<tr><td>{}<td>{}<td>{:.0e}<td>{}<td>{:.3}<td>{:.0} %<td>{}<td>{}<td>{}</tr>",
            run.scene,
            run.method,
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
