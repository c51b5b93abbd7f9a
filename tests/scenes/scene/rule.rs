//! The rule of errors: numbers that describe meshes, positions and poses are input, all else that
//! is passed is a choice.

use super::*;
use nearmiss::Error;
use nearmiss::research::{QueryExt, Traversal};
use nearmiss_io::{Format, MeshFile};

#[derive(Debug, PartialEq)]
enum Class {
    Input,
    Choice,
}

fn class<T>(done: Result<T, Error>) -> Option<Class> {
    match done.err()? {
        Error::Input { .. } => Some(Class::Input),
        Error::InvalidArgument { .. } => Some(Class::Choice),
        other => panic!("{other}"),
    }
}

fn mesh(numbers: Positions, face: [u32; 3]) -> Result<Mesh, Error> {
    Mesh::new("a mesh", numbers, vec![face])
}

fn corners(last: f64) -> Positions {
    Positions::F64(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, last]])
}

/// A detector of a deformable body, a rigid one and a fixed one.
fn detector() -> (OneQuery, [BodyId; 3]) {
    let own = || mesh(corners(0.0), [0, 1, 2]).expect("a mesh");
    let mut scene = Scene::new();
    let ids = [Body::deformable(own()), Body::rigid(own()), Body::fixed(own())].map(|body| scene.add(body));
    (OneQuery::new(engine(), scene, Query::discrete()).expect("a detector"), ids)
}

fn frame(body: usize, input: Motion) -> Result<Contacts, Error> {
    let (mut detector, ids) = detector();
    detector.frame(&[(ids[body], input)])
}

fn posed(rotation: [f64; 4], translation: [f64; 3]) -> Result<Contacts, Error> {
    frame(1, Motion::pose(Pose { rotation, translation }))
}

fn moved(new: Body) -> Result<(), Error> {
    detector().0.move_to(0, new)
}

#[test]
fn every_error_is_of_its_class() {
    let good = corners(0.0);
    let still = |numbers, face| mesh(numbers, face).map(Body::deformable);
    let few = Positions::F64(vec![[0.0; 3]; 2]);
    let more = Positions::F64(vec![[0.0; 3]; 4]);
    let unit = [0.0, 0.0, 0.0, 1.0];
    let of = |query: Query| OneQuery::new(engine(), still(corners(0.0), [0, 1, 2]).expect("a body"), query);
    let input = [
        ("a face's index", class(mesh(corners(0.0), [0, 1, 3]))),
        ("a coordinate", class(mesh(corners(f64::NAN), [0, 1, 2]))),
        ("a large one", class(mesh(corners(1e200), [0, 1, 2]))),
        ("a file's text", class(MeshFile::parse("a.obj", Format::Obj, b"v 0 0 x\n"))),
        ("a file's name", class(MeshFile::read("none.stl".as_ref()))),
        ("a file", class(MeshFile::read("none.ply".as_ref()))),
        ("a frame's coordinate", class(frame(0, Motion::positions(&corners(f64::INFINITY))))),
        ("a step's", class(frame(0, Motion::step(&good, &corners(f64::NAN))))),
        ("how many there are", class(frame(0, Motion::positions(&few)))),
        ("a quaternion", class(posed([0.0; 4], [0.0; 3]))),
        ("a translation", class(posed(unit, [0.0, f64::NAN, 0.0]))),
        ("a large one", class(posed(unit, [0.0, 1e200, 0.0]))),
        (
            "a body's pose",
            class(
                Body::rigid(mesh(corners(0.0), [0; 3]).expect("a mesh"))
                    .at(Motion::pose(Pose::at([f64::NAN; 3]))),
            ),
        ),
        ("more vertices", class(moved(still(more, [0, 1, 2]).expect("a body")))),
        (
            "two frames",
            class(Body::moving(
                mesh(corners(0.0), [0, 1, 2]).expect("a mesh"),
                mesh(corners(0.0), [0; 3]).expect("a mesh"),
            )),
        ),
    ];
    for (what, found) in input {
        assert_eq!(found, Some(Class::Input), "{what}");
    }
    let (mut own, ids) = detector();
    own.remove(ids[0]).expect("a body");
    let fixed = mesh(corners(0.0), [0, 1, 2]).map(Body::fixed).expect("a body");
    let choice = [
        ("a body that is gone", class(own.frame(&[(ids[0], Motion::positions(&good))]))),
        ("to remove it", class(own.remove(ids[0]))),
        ("to replace it", class(own.replace(ids[0], fixed.clone()))),
        (
            "two inputs",
            class(
                detector().0.frame(&[(ids[0], Motion::positions(&good)), (ids[0], Motion::positions(&good))]),
            ),
        ),
        ("a pose of a deformable body", class(frame(0, Motion::pose(Pose::default())))),
        ("positions of a rigid one", class(frame(1, Motion::positions(&good)))),
        ("a frame of a fixed one", class(frame(2, Motion::positions(&good)))),
        ("a distance", class(of(Query::near(f64::NAN)))),
        ("no distance", class(of(Query::near(0.0)))),
        ("a tolerance", class(of(support::asked::with_tolerance(Query::continuous(), -1.0)))),
        (
            "a walk of a distance",
            class(of(Query::distance().with_traversal(Traversal::PerLeaf { budget: None }))),
        ),
        ("no submission", class(detector().0.submit())),
    ];
    for (what, found) in choice {
        assert_eq!(found, Some(Class::Choice), "{what}");
    }
}
