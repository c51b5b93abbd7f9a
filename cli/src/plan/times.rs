//! Predicted times beside measured ones.

use super::calibrate;
use super::model::{Model, STAGES, Sample};
use serde::Serialize;
use std::fmt::Write;

/// A stage's times.
#[derive(Debug, Serialize)]
pub struct Row {
    pub stage: &'static str,
    /// By triangles and vertices alone, milliseconds.
    pub before_ms: f64,
    /// By what a frame launched and found; none where none was asked.
    pub after_ms: Option<f64>,
    /// What that frame took.
    pub measured_ms: Option<f64>,
    /// What it took, over what it would have taken by the model; none of nothing.
    pub ratio: Option<f64>,
}

/// All stages, and last the frame: from positions to contacts, without placing, construction and ordering.
pub fn rows(model: &Model, [triangles, vertices]: [f64; 2], frame: Option<&[Sample; 7]>) -> Vec<Row> {
    let (before, after) = (model.before(triangles, vertices), frame.map(|frame| model.after(frame)));
    let row = |stage, before_ms, both: Option<[f64; 2]>| Row {
        stage,
        before_ms,
        after_ms: both.map(|[after, _]| after),
        measured_ms: both.map(|[_, measured]| measured),
        ratio: both.filter(|[after, _]| *after > 0.0).map(|[after, measured]| measured / after),
    };
    let both = |at: usize| after.zip(frame).map(|(after, frame)| [after[at], frame[at].ms]);
    let mut all: Vec<Row> = (0..STAGES.len()).map(|at| row(STAGES[at].0, before[at], both(at))).collect();
    let own = 2..6;
    let sum = after.zip(frame).map(|(after, frame)| {
        [after[own.clone()].iter().sum(), frame[own.clone()].iter().map(|stage| stage.ms).sum()]
    });
    all.push(row("a frame", before[own].iter().sum(), sum));
    all
}

/// For people.
pub fn text(model: &Model, rows: &[Row]) -> String {
    let [small, large] = model.triangles;
    let mut text = format!(
        "\ntimes, by {} frames each of the scene {} with {small} and {large} triangles, asked here just now:\n",
        calibrate::FRAMES,
        calibrate::SCENE
    );
    let _ = writeln!(text, "  ms         before     after  measured   ratio  by the model");
    let number = |x: Option<f64>| x.map_or("-".into(), |x| format!("{x:.3}"));
    for row in rows {
        let ratio = row.ratio.map_or("-".into(), |ratio| format!("{ratio:.2}"));
        let costs = STAGES.iter().position(|(name, _)| *name == row.stage).map(|at| {
            let (costs, unit) = (model.costs[at], STAGES[at].1);
            format!("{:.1} us a launch, {:.1} ns a {unit}", costs.launch_ms * 1e3, costs.item_ms * 1e6)
        });
        let line = format!(
            "  {:<9} {:>8} {:>9} {:>9} {:>7}  {}",
            row.stage,
            number(Some(row.before_ms)),
            number(row.after_ms),
            number(row.measured_ms),
            ratio,
            costs.unwrap_or_default()
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    let _ = writeln!(text, "  {:.1} GB a second to the device", model.bytes_a_second / 1e9);
    text.push_str("  before: by what moves alone, its node tests and candidates guessed as many a triangle as in that scene;\n");
    let _ = writeln!(
        text,
        "  after: by the launches, node tests and candidates of a frame; measured: medians of {} such; ratio: measured / after",
        super::MEASURED
    );
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::model::Costs;

    fn model() -> Model {
        let costs = Costs { launch_ms: 0.5, item_ms: 0.25 };
        let sample = |items| Sample { launches: 2.0, items, ms: costs.predict(2.0, items) };
        Model::new([10, 20], [[sample(10.0), sample(20.0)]; 7], 1e9)
    }

    /// Frames that take what the model says.
    fn frame() -> [Sample; 7] {
        std::array::from_fn(|at| {
            let (launches, items) = (1.0 + at as f64, 100.0);
            Sample { launches, items, ms: 0.5 * launches + 0.25 * items }
        })
    }

    #[test]
    fn a_model_that_is_right_has_ratios_of_one() {
        let rows = rows(&model(), [100.0, 50.0], Some(&frame()));
        assert_eq!(rows.len(), 8);
        for row in &rows {
            assert!(row.ratio.is_some_and(|ratio| (ratio - 1.0).abs() < 1e-12), "{row:?}");
        }
        let text = text(&model(), &rows);
        assert_eq!(text.matches("    1.00").count(), 8, "{text}");
        assert!(text.contains("500.0 us a launch, 250000.0 ns a node test"), "{text}");
    }

    #[test]
    fn a_wrong_constant_is_told_by_its_ratio() {
        for (at, (stage, _)) in STAGES.iter().enumerate() {
            let mut wrong = model();
            wrong.costs[at].item_ms *= 10.0;
            wrong.costs[at].launch_ms *= 10.0;
            let rows = rows(&wrong, [100.0, 50.0], Some(&frame()));
            let told: Vec<_> =
                rows[..7].iter().filter(|row| row.ratio.is_some_and(|r| (r - 0.1).abs() < 1e-12)).collect();
            assert_eq!(told.iter().map(|row| row.stage).collect::<Vec<_>>(), [*stage]);
            assert!(text(&wrong, &rows).contains("    0.10  "), "{stage}");
        }
    }

    #[test]
    fn without_a_frame_there_is_what_is_known_before() {
        let rows = rows(&model(), [100.0, 0.0], None);
        assert!(rows.iter().all(|row| row.after_ms.is_none() && row.ratio.is_none()), "{rows:?}");
        assert_eq!((rows[0].before_ms, rows[1].before_ms), (0.0, 26.0));
        assert!(text(&model(), &rows).contains("construct   26.000         -         -       -"));
    }
}
