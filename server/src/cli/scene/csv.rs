//! Tables of a run: a comment that states the conventions, a row of names, a row of units, then numbers.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use triad_engine::reactions::JointMultipliers;
use triad_engine::run::{Frame, Summary};

/// One table being written.
pub(in crate::cli) struct Table {
    out: Box<dyn Write>,
}

/// Names of the components of a vector in the head of the table.
const AXES: [&str; 3] = ["x", "y", "z"];

impl Table {
    /// Opens the table (`-` is standard output) and writes its head.
    pub(in crate::cli) fn create(
        path: &Path,
        scene: &str,
        bodies: &[&str],
        joints: &[JointMultipliers],
    ) -> std::io::Result<Self> {
        let out: Box<dyn Write> = if path.as_os_str() == "-" {
            Box::new(BufWriter::new(std::io::stdout()))
        } else {
            Box::new(BufWriter::new(File::create(path)?))
        };
        let mut table = Self { out };
        let version = env!("CARGO_PKG_VERSION");
        writeln!(table.out, "# triad {version}, scene {scene}. All components in the world frame.")?;
        writeln!(table.out, "# r: centre of mass; u, v, w: principal axes; omega: angular velocity.")?;
        for joint in joints {
            writeln!(
                table.out,
                "# {}: force f and moment m on {} by {}, m about the joint's point.",
                joint.joint, joint.on, joint.by
            )?;
        }
        let (mut names, mut units) = (vec!["time".to_owned()], vec!["s"]);
        let mut add = |name: String, unit: &'static str| {
            for axis in AXES {
                names.push(quoted(&format!("{name}{axis}")));
                units.push(unit);
            }
        };
        for body in bodies {
            for (symbol, unit) in
                [("r", "m"), ("u", "1"), ("v", "1"), ("w", "1"), ("v_r", "m/s"), ("omega_", "rad/s")]
            {
                add(format!("{body}.{symbol}"), unit);
            }
        }
        for joint in joints {
            add(format!("{}.f", joint.joint), "N");
            add(format!("{}.m", joint.joint), "N m");
        }
        names.extend(["energy", "position_violation", "velocity_violation"].map(str::to_owned));
        units.extend(["J", "m", "m/s"]);
        writeln!(table.out, "{}", names.join(","))?;
        writeln!(table.out, "{}", units.join(","))?;
        Ok(table)
    }

    /// Writes one instant.
    pub(in crate::cli) fn row(
        &mut self,
        frame: &Frame,
        joints: &[JointMultipliers],
        summary: &Summary,
    ) -> std::io::Result<()> {
        write!(self.out, "{}", number(frame.time))?;
        let bodies =
            frame.bodies.iter().flat_map(|b| [b.position, b.u, b.v, b.w, b.velocity, b.angular_velocity]);
        let reactions = joints.iter().flat_map(|joint| [joint.force, joint.moment]);
        for value in bodies.chain(reactions).flatten() {
            write!(self.out, ",{}", number(value))?;
        }
        let [e, p, v] = [summary.energy, summary.position_violation, summary.velocity_violation].map(number);
        writeln!(self.out, ",{e},{p},{v}")
    }

    /// Writes what is still held back.
    pub(in crate::cli) fn finish(mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}

/// The shortest text that reads back as the same number.
fn number(x: f64) -> String {
    if x == 0.0 || (1e-4..1e9).contains(&x.abs()) { format!("{x}") } else { format!("{x:e}") }
}

/// A field, in quotation marks if it needs them.
fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_exactly_and_names_cannot_break_a_row() {
        for x in [0.1, -1e-17, 6.02e23, 0.0, 1.0 / 3.0, 123_456.789] {
            assert_eq!(number(x).parse::<f64>().ok(), Some(x));
        }
        assert_eq!(quoted("a,\"b\""), "\"a,\"\"b\"\"\"");
    }
}
