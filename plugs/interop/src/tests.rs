//! Laws of updates and submissions on the CPU, with arrays of a library that logs their orders.

use crate::array::{DeviceArray, OwnedArray, sealed};
use crate::element::Element;
use crate::{Input, Place, Submissions, update};
use nearmiss::device::Backend;
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, Motion, Pose};
use nearmiss::{Body, Detector, Device, Earliest, Error, Mesh, Near, Query};
use std::cell::{Cell, RefCell};
use std::rc::Rc;

/// Events of arrays, in order.
type Log = Rc<RefCell<Vec<&'static str>>>;

/// An array of the host; a CPU is a device that reads it. Freed memory holds NaN, which is refused.
struct Array<T> {
    elements: Box<[Cell<T>]>,
    log: Log,
}

/// An order of an array.
struct Order<'a>(&'a Log);

impl Drop for Order<'_> {
    fn drop(&mut self) {
        self.0.borrow_mut().push("released");
    }
}

impl<T> Drop for Array<T> {
    fn drop(&mut self) {
        self.log.borrow_mut().push("freed");
    }
}

// SAFETY: the boxed elements stay at their address until the array is dropped, and a CPU reads them.
unsafe impl<T: Element> sealed::Ordered for Array<T> {
    type Order<'a> = Order<'a>;
    fn order<'a>(&'a self, device: &'a Device) -> Result<(u64, Order<'a>), Error> {
        assert!(!device.is_gpu());
        self.log.borrow_mut().push("ordered");
        Ok((self.elements.as_ptr() as u64, Order(&self.log)))
    }
}

impl<T: Element> DeviceArray for Array<T> {
    type Element = T;
    fn elements(&self) -> usize {
        self.elements.len()
    }
}

impl<T: Element> OwnedArray for Array<T> {
    type View<'a> = &'a [Cell<T>];
    fn view(&mut self) -> &[Cell<T>] {
        &self.elements
    }
}

fn array<T: Copy>(log: &Log, elements: &[T]) -> Array<T> {
    Array { elements: elements.iter().copied().map(Cell::new).collect(), log: log.clone() }
}

fn corners(z: f32) -> [[f32; 3]; 3] {
    [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]]
}

/// A cloth above a floor and a rigid ball, all of one triangle; cloth and ball.
fn scene() -> (Detector, BodyId, BodyId) {
    let mesh =
        |name, z| Mesh::new(name, Positions::F32(corners(z).to_vec()), vec![[0, 1, 2]]).expect("a mesh");
    let bodies = vec![
        Body::deformable(mesh("cloth", 9.0)),
        Body::rigid(mesh("ball", 0.0)),
        Body::fixed(mesh("floor", 0.0)),
    ];
    let device = Device::open(Backend::Cpu, Some(1)).expect("a thread");
    let mut detector = Detector::new(device, bodies).expect("a detector");
    let ids: Vec<BodyId> = detector.scene().ids().collect();
    detector.update(&[(ids[1], Motion::pose(Pose::at([50.0, 0.0, 0.0])))]).expect("away");
    (detector, ids[0], ids[1])
}

fn query() -> Query {
    Near::within(1.5).into()
}

fn near(detector: &mut Detector) -> (usize, u64) {
    let found = detector.query(&query()).expect("an answer");
    (found.len(), found.hash())
}

/// The answer for a cloth of the host.
fn wanted(z: f32) -> (usize, u64) {
    let (mut detector, cloth, _) = scene();
    detector.update(&[(cloth, Motion::positions(&corners(z)))]).expect("moved");
    near(&mut detector)
}

/// The answer for a cloth in an array of these elements; the log.
fn found<T: Element>(elements: &[T]) -> Result<(usize, u64), String> {
    let (mut detector, cloth, _) = scene();
    let array = array(&Log::default(), elements);
    update(&mut detector, &[(cloth, Input::positions(&array))]).map_err(|error| error.to_string())?;
    assert_eq!(*array.log.borrow(), ["ordered", "released"]);
    Ok(near(&mut detector))
}

#[test]
fn every_type_has_the_answer_of_the_host() {
    for z in [1.0, 1.25, 3.0] {
        let rows = corners(z);
        let four = |fourth: f32| rows.map(|[x, y, z]| [x, y, z, fourth]);
        let wide = rows.map(|row| row.map(f64::from));
        let wanted = Ok(wanted(z));
        assert_eq!(found(rows.as_flattened()), wanted);
        assert_eq!(found(&rows), wanted);
        assert_eq!(found(&four(f32::NAN)), wanted);
        assert_eq!(found(wide.as_flattened()), wanted);
        assert_eq!(found(&wide), wanted);
        assert_eq!(found(&wide.map(|[x, y, z]| [x, y, z, f64::NAN])), wanted);
    }
    assert!(wanted(1.0).0 > 0 && wanted(1.0) != wanted(1.25) && wanted(3.0).0 == 0);
}

#[test]
fn another_number_of_vertices_is_refused() {
    let rows = corners(1.0);
    for wrong in [0, 3, 6, 12] {
        let error = found(&rows.concat().repeat(2)[..wrong]).expect_err("another number of vertices");
        assert!(error.starts_with("cloth: ") && error.contains(&(wrong / 3).to_string()), "{error}");
        assert!(
            found(&rows.concat().repeat(2)[..wrong + 1]).expect_err("no vertices").contains("three numbers")
        );
    }
    assert!(found(&rows[..2]).expect_err("two").starts_with("cloth: "));
}

#[test]
fn positions_are_refused_for_a_rigid_body_and_nan_for_all() {
    let (mut detector, cloth, ball) = scene();
    let log = Log::default();
    let [good, bad] = [1.0, f32::NAN].map(|z| array(&log, &corners(z)));
    let error = update(&mut detector, &[(ball, Input::positions(&good))]).expect_err("a ball has poses");
    assert!(error.to_string().contains("give a rigid body poses"), "{error}");
    assert!(matches!(update(&mut detector, &[(cloth, Input::positions(&bad))]), Err(Error::Input { .. })));
    update(&mut detector, &[(cloth, Input::positions(&good))]).expect("the detector stays usable");
    assert_eq!(near(&mut detector), wanted(1.0));
}

#[test]
fn arrays_and_motions_of_the_host_share_a_frame() {
    let (mut detector, cloth, ball) = scene();
    let log = Log::default();
    let [start, end] = [2.0, -1.0].map(|z| array(&log, &corners(z)));
    let pose = Motion::pose(Pose::at([0.0, 0.0, 2.5]));
    update(&mut detector, &[(cloth, Input::step(&start, &end)), (ball, pose.into())]).expect("moved");
    assert_eq!(*log.borrow(), ["ordered", "ordered", "released", "released"]);
    drop((start, end));
    let (mut judge, cloth, ball) = scene();
    judge.update(&[(cloth, Motion::step(&corners(2.0), &corners(-1.0))), (ball, pose)]).expect("moved");
    let earliest = Query::from(Earliest::default());
    let [found, wanted] = [&mut detector, &mut judge].map(|d| d.query(&earliest).expect("an answer").hash());
    assert_eq!(found, wanted);
    assert_eq!(near(&mut detector), near(&mut judge));
}

/// Submissions of a cloth, prepared.
fn submissions(log: &Log, z: f32) -> Submissions<Array<[f32; 3]>> {
    let (detector, cloth, _) = scene();
    let mut all = Submissions::new(detector, vec![(cloth, Place::Positions(array(log, &corners(z))))]);
    all.prepare(&[query()]).expect("prepared");
    all
}

fn write(all: &mut Submissions<Array<[f32; 3]>>, z: f32) {
    for (_, place) in all.views() {
        let Place::Positions(view) = place else { panic!("one end") };
        view.iter().zip(corners(z)).for_each(|(row, at)| row.set(at));
    }
}

#[test]
fn submissions_read_the_arrays_as_they_are() {
    let log = Log::default();
    let mut all = submissions(&log, 2.0);
    for z in [1.0, 3.0, 1.25] {
        if !all.detector().is_prepared() {
            all.prepare(&[query()]).expect("prepared again");
        }
        write(&mut all, z);
        log.borrow_mut().clear();
        all.submit().expect("submitted");
        assert_eq!(*log.borrow(), ["ordered", "released"]);
        let found = all.collect(&query()).expect("an answer");
        assert_eq!((found.len(), found.hash()), wanted(z));
    }
}

#[test]
fn arrays_that_were_given_back_are_not_read() {
    let log = Log::default();
    let mut all = submissions(&log, 2.0);
    write(&mut all, 1.0);
    all.submit().expect("submitted");
    write(&mut all, f32::NAN);
    let (mut detector, arrays) = all.into_parts().expect("settled");
    drop(arrays);
    assert!(!detector.is_prepared() && detector.submit().is_err());
    assert_eq!(near(&mut detector), wanted(1.0));
    assert_eq!(log.borrow().last(), Some(&"freed"));
}

#[test]
fn a_leaked_value_leaks_its_arrays() {
    let log = Log::default();
    std::mem::forget(submissions(&log, 2.0));
    assert!(!log.borrow().contains(&"freed"));
    drop(submissions(&log, 2.0));
    assert_eq!(log.borrow().last(), Some(&"freed"));
}

#[test]
fn wrong_arrays_are_refused_when_they_are_prepared() {
    let (detector, cloth, _) = scene();
    let two = array(&Log::default(), &corners(1.0)[..2]);
    let mut all = Submissions::new(detector, vec![(cloth, Place::Positions(two))]);
    assert!(all.submit().is_err(), "nothing is prepared");
    let error = all.prepare(&[query()]).expect_err("two vertices").to_string();
    assert!(error.starts_with("cloth: "), "{error}");
    let (mut detector, arrays) = all.into_parts().expect("settled");
    assert_eq!((arrays.len(), near(&mut detector).0), (1, 0));
}
