//! How long a stage takes on a machine: so much a launch, and so much for each thing that it works on.

use serde::Serialize;

/// What the stages work on: a stage's name and its unit, in their order.
pub const STAGES: [(&str, &str); 7] = [
    ("place", "vertex that moves"),
    ("construct", "triangle that moves"),
    ("fit", "triangle that moves"),
    ("refit", "triangle that moves"),
    ("traverse", "node test"),
    ("narrow", "candidate"),
    ("order", "contact"),
];

/// The first of [`STAGES`] whose work is known only when it is done.
pub const FOUND: usize = 4;

/// A stage that ran: its launches, what it worked on, and its milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Sample {
    pub launches: f64,
    pub items: f64,
    pub ms: f64,
}

/// A stage's costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Costs {
    /// Milliseconds a launch; of a stage that copies and launches nothing, of the stage.
    pub launch_ms: f64,
    /// Milliseconds for each thing.
    pub item_ms: f64,
}

impl Costs {
    /// The costs that two runs of different sizes had, through both; where that would make one of them negative it is none, and the
    /// other one fits both best.
    pub fn of([a, b]: [Sample; 2]) -> Costs {
        let det = a.launches * b.items - b.launches * a.items;
        let (launch_ms, item_ms) =
            ((a.ms * b.items - b.ms * a.items) / det, (a.launches * b.ms - b.launches * a.ms) / det);
        let best = |x: [f64; 2]| {
            let squares = x[0] * x[0] + x[1] * x[1];
            if squares > 0.0 { (x[0] * a.ms + x[1] * b.ms) / squares } else { 0.0 }
        };
        // NaN, of two runs that tell nothing apart, is in no range.
        let is_cost = |x: f64| (0.0..f64::INFINITY).contains(&x);
        match (is_cost(launch_ms), is_cost(item_ms)) {
            (true, true) => Costs { launch_ms, item_ms },
            (true, false) => Costs { launch_ms: best([a.launches, b.launches]), item_ms: 0.0 },
            _ => Costs { launch_ms: 0.0, item_ms: best([a.items, b.items]) },
        }
    }

    /// Milliseconds that so many launches take over so many things.
    pub fn predict(&self, launches: f64, items: f64) -> f64 {
        self.launch_ms * launches + self.item_ms * items
    }
}

/// What is known of a machine, for one way of asking.
#[derive(Clone, Debug, Serialize)]
pub struct Model {
    /// Triangles of the two runs.
    pub triangles: [usize; 2],
    /// Both runs of each stage.
    pub samples: [[Sample; 2]; 7],
    /// The costs through them.
    pub costs: [Costs; 7],
    /// Bytes a second from the host to the device.
    pub bytes_a_second: f64,
}

impl Model {
    /// Of the runs of all stages.
    pub fn new(triangles: [usize; 2], samples: [[Sample; 2]; 7], bytes_a_second: f64) -> Model {
        Model { triangles, samples, costs: samples.map(Costs::of), bytes_a_second }
    }

    /// What a scene of so many triangles and vertices that move would take, as far as that tells: launches and what is found by the
    /// triangle are those of the larger run.
    pub fn before(&self, triangles: f64, vertices: f64) -> [f64; 7] {
        std::array::from_fn(|at| {
            let large = self.samples[at][1];
            let items = match at {
                0 => vertices,
                _ if at < FOUND => triangles,
                _ => large.items * triangles / self.triangles[1] as f64,
            };
            let launches = if items > 0.0 { large.launches } else { 0.0 };
            self.costs[at].predict(launches, items)
        })
    }

    /// What a frame that launched and found so much would take.
    pub fn after(&self, frame: &[Sample; 7]) -> [f64; 7] {
        std::array::from_fn(|at| self.costs[at].predict(frame[at].launches, frame[at].items))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(launches: f64, items: f64, costs: Costs) -> Sample {
        Sample { launches, items, ms: costs.predict(launches, items) }
    }

    #[test]
    fn costs_go_through_known_points() {
        for (launch_ms, item_ms) in [(0.01, 1e-4), (0.0, 1e-4), (0.5, 0.0), (0.0, 0.0)] {
            let costs = Costs { launch_ms, item_ms };
            for launches in [[1.0, 1.0], [7.0, 11.0]] {
                let found = Costs::of([sample(launches[0], 2e3, costs), sample(launches[1], 16e3, costs)]);
                assert!((found.launch_ms - launch_ms).abs() < 1e-12, "{found:?}");
                assert!((found.item_ms - item_ms).abs() < 1e-15, "{found:?}");
            }
        }
        assert_eq!(Costs { launch_ms: 0.5, item_ms: 0.25 }.predict(2.0, 8.0), 3.0);
    }

    #[test]
    fn no_cost_is_negative_and_nothing_is_no_number() {
        let of = |points: [[f64; 3]; 2]| {
            Costs::of(points.map(|[launches, items, ms]| Sample { launches, items, ms }))
        };
        // Dearer by the thing when there is more of it: nothing is left for launches.
        let steep = of([[1.0, 10.0, 1.0], [1.0, 100.0, 20.0]]);
        assert!(steep.launch_ms == 0.0 && (steep.item_ms - 2010.0 / 10100.0).abs() < 1e-12, "{steep:?}");
        // Less time for more: only launches.
        assert_eq!(of([[1.0, 10.0, 3.0], [1.0, 100.0, 1.0]]), Costs { launch_ms: 2.0, item_ms: 0.0 });
        // No launches, the same size twice, nothing at all.
        assert_eq!(of([[0.0, 10.0, 1.0], [0.0, 20.0, 2.0]]), Costs { launch_ms: 0.0, item_ms: 0.1 });
        assert_eq!(of([[1.0, 10.0, 1.0], [1.0, 10.0, 1.0]]), Costs { launch_ms: 0.0, item_ms: 0.1 });
        assert_eq!(of([[0.0; 3]; 2]), Costs::default());
    }

    #[test]
    fn what_is_known_before_scales_with_triangles() {
        let costs = Costs { launch_ms: 1.0, item_ms: 0.5 };
        let samples = [[sample(2.0, 10.0, costs), sample(2.0, 40.0, costs)]; 7];
        let model = Model::new([10, 20], samples, 1e9);
        // Vertices and triangles are known; of what is found, two for each triangle, as in the larger run.
        assert_eq!(model.before(100.0, 60.0), [32.0, 52.0, 52.0, 52.0, 102.0, 102.0, 102.0]);
        assert_eq!(model.before(100.0, 0.0)[0], 0.0, "nothing is placed");
        let frame = [Sample { launches: 3.0, items: 4.0, ms: 9.0 }; 7];
        assert_eq!(model.after(&frame), [5.0; 7]);
    }
}
