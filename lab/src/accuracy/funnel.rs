//! The funnel: how many pairs each step of a frame leaves to the next, and its time.

use crate::OneQuery;
use crate::tables::{Printed, digits};
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::mesh::Body;
use nearmiss::query::Query;
use serde::Serialize;

/// A step of a frame.
#[derive(Clone, Debug, Serialize)]
pub struct FunnelRow {
    /// The scene.
    pub input: String,
    /// Name of the pairs that the step leaves.
    pub step: &'static str,
    /// Vertex/face pairs.
    pub vertex_face: Option<u64>,
    /// Edge/edge pairs.
    pub edge_edge: Option<u64>,
    /// All pairs.
    pub pairs: u64,
    /// Milliseconds of the step; the solver's rungs run as one.
    pub ms: Option<f64>,
}

/// Returns the steps of one frame of the default continuous query.
///
/// # Errors
/// Device errors.
pub fn funnel(device: &Device, name: &str, body: &Body) -> Result<Vec<FunnelRow>, Error> {
    let mut detector = OneQuery::new(device.clone(), vec![body.clone()], Query::continuous())?;
    detector.detect()?;
    let contacts = detector.detect()?;
    let steps = detector.narrow_steps()?;
    let ms = |name: &str| steps.iter().find(|step| step.0 == name).map(|step| step.1);
    let row = |step, pairs, ms| FunnelRow {
        input: name.into(),
        step,
        vertex_face: None,
        edge_edge: None,
        pairs,
        ms,
    };
    let both = |step, [vf, ee]: [u64; 2], ms| FunnelRow {
        vertex_face: Some(vf),
        edge_edge: Some(ee),
        ..row(step, vf + ee, ms)
    };
    let found = contacts.len() as u64;
    Ok(vec![
        row(
            "triangle pairs",
            contacts.stats.triangle_pairs,
            Some(contacts.stats.stages.traverse + contacts.stats.stages.balance),
        ),
        both("features with swept boxes that meet", contacts.stats.candidates_vf_ee, ms("features")),
        both("left by the filters", contacts.stats.survivors_vf_ee, ms("cull")),
        both("tested in f64 after f32", contacts.stats.escalated_vf_ee, None),
        both("not isolated in f64 either", contacts.stats.open_vf_ee, None),
        both("cut into slices", contacts.stats.sliced_vf_ee, None),
        row("listed", found, ms("solve")),
        row("of them certain", found - contacts.undecided, None),
    ])
}

impl Printed for FunnelRow {
    const CAPTION: &'static str = "The funnel: what each step leaves to the next, and its milliseconds";
    const HEADS: &'static [&'static str] = &["input", "pairs", "vertex/face", "edge/edge", "all", "ms"];
    fn row(&self) -> Vec<String> {
        let maybe = |n: Option<u64>| n.map_or("-".into(), |n| n.to_string());
        vec![
            self.input.clone(),
            self.step.into(),
            maybe(self.vertex_face),
            maybe(self.edge_edge),
            self.pairs.to_string(),
            self.ms.map_or("-".into(), digits),
        ]
    }
}
