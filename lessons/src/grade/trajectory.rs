//! A table of a motion, from any program, against the reference.

use super::Outcome;
use crate::exercise::Trajectory;
use crate::markdown::{escape, render_short};
use crate::submission::Answer;
use crate::table;
use crate::tolerance::plain;
use crate::trajectory::{Deviation, Track};
use crate::verdict::Mark;

/// Fewest samples.
const FEWEST: usize = 20;
/// Longest time without a sample, as a part of the whole.
const LONGEST_GAP: f64 = 0.05;
/// An error is of one kind if this part of it, or less, is left without that kind.
const EXPLAINED: f64 = 0.25;

/// Judges a table.
pub(super) fn judge(task: &Trajectory, note: &str, answer: &Answer) -> Outcome {
    let Some(text) = &answer.file else {
        return Outcome::invalid("This question asks for a table (CSV) that your program writes.");
    };
    let (times, given) = match read(task, text) {
        Ok(read) => read,
        Err(problem) => return Outcome::invalid(&problem),
    };
    let track = match Track::new(task) {
        Ok(track) => track,
        Err(problem) => return Outcome::invalid(&format!("The reference could not be run: {problem}.")),
    };
    let deviation = track.deviation(&times, &given);
    let share = task.bands.iter().find(|b| deviation.total <= b.error).map_or(0.0, |b| b.share);
    let told = format!("<p>The error is {} %.</p>", percent(deviation.total));
    if share == 1.0 {
        let html = format!("<p>Right.</p>{told}{}", render_short(note));
        return Outcome { mark: Mark::Right, share, html, ..Outcome::default() };
    }
    let (slip, what) = kind(task, &deviation, &times, &given, &track);
    let html = format!("<p>Not close enough.</p>{told}<p>{}</p>", escape(&what));
    Outcome { mark: Mark::Wrong, share, html, slip: slip.map(str::to_owned), ..Outcome::default() }
}

fn percent(x: f64) -> String {
    plain(format!("{:.2e}", 100.0 * x).parse().unwrap_or(100.0 * x))
}

/// Times, and the values of the columns in the question's order.
fn read(task: &Trajectory, text: &str) -> Result<(Vec<f64>, Vec<Vec<f64>>), String> {
    let table = table::read(text)?;
    let place = |name: &str| {
        table.names.iter().position(|n| *n == name.to_lowercase()).ok_or_else(|| {
            format!("There is no column {name}; the first line names {}.", table.names.join(", "))
        })
    };
    let time = place("t")?;
    let columns: Vec<usize> = task.columns.keys().map(|name| place(name)).collect::<Result<_, _>>()?;
    let times: Vec<f64> = table.rows.iter().map(|row| row[time]).collect();
    if times.len() < FEWEST {
        return Err(format!("There are {} rows; at least {FEWEST} are needed.", times.len()));
    }
    if let Some(k) = times.windows(2).position(|w| w[1] <= w[0]) {
        return Err(format!("Times must grow; they do not from {} to {} s.", times[k], times[k + 1]));
    }
    let tiny = 1e-6 * task.end;
    let (first, last) = (times[0], times[times.len() - 1]);
    if first > tiny || first < -tiny || last < task.end - tiny {
        return Err(format!("The table goes from {first} to {last} s; it must cover 0 to {} s.", task.end));
    }
    let gap = times.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    if gap > LONGEST_GAP * task.end {
        let most = plain(LONGEST_GAP * task.end);
        return Err(format!("There is a gap of {} s between two rows; at most {most} s.", plain(gap)));
    }
    // What lies beyond the end is not asked for.
    let kept = times.iter().take_while(|t| **t <= task.end + tiny).count();
    let given = columns.iter().map(|c| table.rows[..kept].iter().map(|row| row[*c]).collect()).collect();
    Ok((times[..kept].to_vec(), given))
}

/// Which kind of error it is, and what to say of it.
fn kind(
    task: &Trajectory,
    d: &Deviation,
    times: &[f64],
    given: &[Vec<f64>],
    track: &Track,
) -> (Option<&'static str>, String) {
    let late = if d.late > 0.0 { "late" } else { "early" };
    let phase =
        format!("it comes {} s too {late}", plain(format!("{:.2e}", d.late.abs()).parse().unwrap_or(0.0)));
    let larger = if d.factor > 1.0 { "large" } else { "small" };
    let amplitude = format!("its swings are {} % too {larger}", percent((d.factor - 1.0).abs()));
    let negative = given.iter().map(|v| v.iter().map(|x| -x).collect()).collect::<Vec<Vec<f64>>>();
    let best = task.bands.last().map_or(0.0, |b| b.error);
    if d.total > best && track.deviation(times, &negative).total <= best {
        return (
            Some("opposite-sign"),
            "Every value has the opposite sign: the other direction, or the other side.".to_owned(),
        );
    }
    if d.without_phase <= EXPLAINED * d.total {
        let hint = "An error that grows with time like this comes from the step or the tolerance, a constant one from the start";
        return (Some("phase"), format!("The motion has the right form, but {phase}. {hint}."));
    }
    if d.without_factor <= EXPLAINED * d.total {
        let hint = "Look at the start, at lengths, and at units";
        return (Some("amplitude"), format!("The motion has the right rhythm, but {amplitude}. {hint}."));
    }
    if d.rest <= EXPLAINED * d.total && d.factor > 0.0 {
        return (
            Some("phase-and-amplitude"),
            format!("Phase and amplitude are both off: {phase}, and {amplitude}."),
        );
    }
    (None, "Neither a delay nor a factor explains the difference: it is another motion. Compare the first tenth of a second by hand.".to_owned())
}
