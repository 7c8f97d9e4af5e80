//! `--vary`: which number of a scene takes which values.

use axum::http::StatusCode;
use triad_engine::EngineError;
use triad_engine::scene::Scene;
use triad_lab::sweep::{Values, Variation};

use crate::problem::Problem;

/// Reads `NAME=FROM:TO:COUNT`, `NAME=uniform:FROM:TO` or `NAME=normal:MEAN:DEVIATION`.
pub(super) fn variation(scene: &Scene, text: &str) -> Result<Variation, Problem> {
    let read = || -> Result<_, String> {
        let (name, written) = text.rsplit_once('=').ok_or("no = stands between a name and its values")?;
        Ok((name, values(written)?))
    };
    let (name, values) = read().map_err(|reason| {
        Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "vary-syntax",
            format!("--vary {text}: {reason}"),
            "write NAME=FROM:TO:COUNT, NAME=uniform:FROM:TO or NAME=normal:MEAN:DEVIATION, like /bodies/0/mass=1:2:11",
        )
    })?;
    Ok(Variation::new(scene, name, values).map_err(EngineError::from)?)
}

/// The values, or what is wrong with them.
fn values(text: &str) -> Result<Values, String> {
    match text.split(':').collect::<Vec<_>>()[..] {
        ["uniform", from, to] => Ok(Values::Uniform { from: number(from)?, to: number(to)? }),
        ["normal", mean, deviation] => {
            let (mean, deviation) = (number(mean)?, number(deviation)?);
            if deviation < 0.0 {
                return Err(format!("a deviation is not below 0, as {deviation} is"));
            }
            Ok(Values::Normal { mean, deviation })
        }
        [from, to, count] => {
            let (from, to) = (number(from)?, number(to)?);
            let whole = count.trim().parse().ok().filter(|count| *count > 0);
            let count = whole
                .ok_or_else(|| format!("the count is a whole number from 1 on, and \"{count}\" is none"))?;
            Ok(Values::Grid { from, to, count })
        }
        _ => Err(format!("\"{text}\" is no grid and no distribution")),
    }
}

fn number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    number.ok_or_else(|| format!("\"{text}\" is no finite number"))
}
