//! The distance of a result from the removed surface.

use std::path::Path;
use std::time::Duration;

use serde_json::Value;

use crate::ply::{self, Mesh};
use crate::{Result, deviation, process};

/// Time that an external scorer may take.
const SCORER_LIMIT: Duration = Duration::from_secs(600);

/// Figures of a result. Only an external scorer gives the last two.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Score {
    /// Two-way RMS distance over the size of the hole; `None` without truth or without patch.
    pub(crate) sym_rms: Option<f64>,
    pub(crate) ok: Option<bool>,
    /// Pairs of intersecting triangles, at least one of them in the patch.
    pub(crate) intersections: Option<u64>,
}

/// The new faces of an output. Both programs write the faces of the input first.
fn patch_of(input: &Mesh, output: Mesh) -> Result<Mesh> {
    if !output.triangles.starts_with(&input.triangles) || !output.points.starts_with(&input.points)
    {
        return Err("the output does not begin with the input".into());
    }
    let triangles = output.triangles[input.triangles.len()..].to_vec();
    Ok(Mesh {
        points: output.points,
        triangles,
    })
}

fn built_in(case: &Path, output: &Path) -> Result<Score> {
    let patch = patch_of(&ply::read(&case.join("input.ply"))?, ply::read(output)?)?;
    let truth = case.join("truth.ply");
    let sym_rms = match truth.exists() {
        true => deviation::symmetric_rms(&patch, &ply::read(&truth)?),
        false => None,
    };
    Ok(Score {
        sym_rms,
        ..Score::default()
    })
}

fn external(command: &str, case: &Path, output: &Path) -> Result<Score> {
    let mut words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
    words.extend([case, output].map(|path| path.display().to_string()));
    words.push("--json".into());
    let log = output.with_extension("score");
    let outcome = process::run(&words, &log, SCORER_LIMIT)?;
    if outcome.timed_out || outcome.code != Some(0) {
        return Err(format!("the scorer failed on {}", output.display()).into());
    }
    let text = std::fs::read_to_string(process::beside(&log, "out"))?;
    let json: Value = serde_json::from_str(&text)?;
    let pairs = |key: &str| json[key].as_u64();
    Ok(Score {
        sym_rms: json["sym_rms"].as_f64(),
        ok: json["ok"].as_bool(),
        intersections: pairs("selfint_patch_patch")
            .zip(pairs("selfint_patch_rest"))
            .map(|(a, b)| a + b),
    })
}

/// Scores the output for a case.
pub(crate) fn score(scorer: Option<&str>, case: &Path, output: &Path) -> Result<Score> {
    match scorer {
        Some(command) => external(command, case, output),
        None => built_in(case, output),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_that_changed_the_input_is_refused() {
        let input = Mesh {
            points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2]],
        };
        let mut output = input.clone();
        output.points.push([1.0; 3]);
        output.triangles.push([1, 3, 2]);
        assert_eq!(
            patch_of(&input, output.clone()).unwrap().triangles,
            [[1, 3, 2]]
        );
        output.points[1][2] = f64::MIN_POSITIVE;
        assert!(patch_of(&input, output).is_err());
        assert!(patch_of(&input, Mesh::default()).is_err());
    }
}
