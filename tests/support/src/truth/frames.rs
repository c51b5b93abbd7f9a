//! Two public pairs of frames with lists of all true contacts, and the comparison of lists.

use crate::{mesh, rows};
use nearmiss::contacts::Kind;
use nearmiss::mesh::Body;
use nearmiss::{Contacts, Mesh};

/// A feature pair.
pub type Row = (Kind, u32, u32);

/// A pair of frames and its known answers.
pub struct Scene {
    pub name: &'static str,
    t0: &'static str,
    t1: &'static str,
    list: &'static str,
    /// Vertex/face and edge/edge pairs without a common vertex whose swept boxes overlap: counted
    /// separately, in exact boxes.
    pub candidates: [u64; 2],
    /// The pairs among them that directions do not part, and whose boxes, moving with their
    /// triangles, overlap. Measured with tests/frames/contacts.rs; equal for moving and other
    /// volumes.
    pub near: [u64; 2],
    /// The exact time of the first contact.
    pub earliest: f64,
}

pub const CLOTH: Scene = Scene {
    name: "cloth-ball 92 to 93",
    t0: "cloth-ball/cloth_ball92.ply",
    t1: "cloth-ball/cloth_ball93.ply",
    list: "cloth-ball/true_contacts.csv.gz",
    candidates: [1_655_541, 5_197_332],
    near: [246_179, 840_796],
    earliest: 7.49206918682e-06,
};
pub const BALLS: Scene = Scene {
    name: "n-body 18 to 19",
    t0: "n-body/n-body_t0.ply",
    t1: "n-body/n-body_t1.ply",
    list: "n-body/true_contacts.csv.gz",
    candidates: [9_396_388, 22_366_873],
    near: [57_011, 206_635],
    earliest: 0.0,
};

impl Scene {
    /// The moving mesh.
    pub fn body(&self) -> Body {
        Body::moving(mesh(self.t0), mesh(self.t1)).expect("two frames of one mesh")
    }

    /// The first frame.
    pub fn mesh(&self) -> Mesh {
        mesh(self.t0)
    }

    /// All true contacts, ascending.
    pub fn truth(&self) -> Vec<Row> {
        let row = |row: &Vec<String>| {
            let kind = match row[0].as_str() {
                "vf" => Kind::Vf,
                "ee" => Kind::Ee,
                other => panic!("a kind {other}"),
            };
            let index = |text: &String| text.trim().parse().expect("an index");
            (kind, index(&row[1]), index(&row[2]))
        };
        let mut all: Vec<Row> = rows(self.list).iter().map(row).collect();
        all.sort_unstable();
        all
    }
}

/// The rows of an answer, ascending.
pub fn found(contacts: &Contacts) -> Vec<Row> {
    contacts.contacts().iter().map(|c| (c.kind, c.feature_a, c.feature_b)).collect()
}

/// Differences of two ascending lists.
#[derive(Debug, PartialEq)]
pub struct Difference<T> {
    /// In the truth only.
    pub missed: Vec<T>,
    /// In the answer only.
    pub invented: Vec<T>,
}

/// Compares ascending lists.
pub fn difference<T: Copy + Ord>(found: &[T], truth: &[T]) -> Difference<T> {
    assert!(found.is_sorted() && truth.is_sorted());
    let without =
        |all: &[T], known: &[T]| all.iter().filter(|x| known.binary_search(x).is_err()).copied().collect();
    Difference { missed: without(truth, found), invented: without(found, truth) }
}

/// The number of contacts of both answers that one reports later than the other by more than
/// `margin`, and the largest delay.
pub fn later(one: &Contacts, other: &Contacts, margin: f64) -> (usize, f64) {
    let (mut count, mut most) = (0, 0f64);
    let reference = other.contacts();
    for c in one.contacts() {
        if let Ok(at) = reference
            .binary_search_by_key(&(c.kind, c.feature_a, c.feature_b), |c| (c.kind, c.feature_a, c.feature_b))
        {
            let by = c.toi - reference[at].toi;
            count += (by > margin) as usize;
            most = most.max(by);
        }
    }
    (count, most)
}
