//! Pairs of bodies that are left out.

use super::refusals::refused;
use super::*;
use nearmiss_lab::scene::soup;

/// Pairs of bodies that a list leaves out have no rows.
#[test]
fn a_list_leaves_out_pairs() {
    let soups = [4, 5, 6].map(|seed| soup(60, seed, false).expect("a soup"));
    let bodies = soups.each_ref().map(|body| NearmissBody { self_collision: 0, ..described(body) });
    let discrete = nearmiss_query(NearmissQueryKind::NEARMISS_DISCRETE as u32);
    let rows = |own: &mut NearmissDetector| -> Vec<[u32; 2]> {
        let answer = query(own, &discrete).expect("an answer");
        let rows = list(|to, n, e| nearmiss_answer_triangle_pairs(Some(&answer), to, n, e)).expect("rows");
        rows.iter().map(|pair| [pair.bodies[0], pair.bodies[1]]).collect()
    };
    let leave_out = |own: &mut NearmissDetector, pairs: &[[u32; 2]]| {
        // SAFETY: as many numbers are there.
        told(|e| unsafe { nearmiss_detector_leave_out(Some(own), pairs.as_ptr().cast(), pairs.len(), e) })
    };
    let left_out = |own: &mut NearmissDetector| -> Vec<[u32; 2]> {
        let mut count = MaybeUninit::uninit();
        let pairs = got(|to, e| nearmiss_detector_left_out(Some(own), to, Some(&mut count), e));
        // SAFETY: a call that succeeds writes both; as many pairs are there until the next change.
        unsafe { std::slice::from_raw_parts(pairs.expect("pairs").cast(), count.assume_init()) }.to_vec()
    };
    let mut all = detector(&bodies);
    let whole = rows(&mut all);
    let less =
        |list: &[[u32; 2]]| whole.iter().filter(|pair| !list.contains(pair)).copied().collect::<Vec<_>>();
    assert_eq!(leave_out(&mut all, &[[2, 0], [1, 2], [0, 2]]), Ok(()));
    assert_eq!(left_out(&mut all), [[0, 2], [1, 2]]);
    assert_eq!(rows(&mut all), less(&[[0, 2], [1, 2]]));
    assert!(!rows(&mut all).is_empty() && rows(&mut all).len() < whole.len());
    for (pairs, says) in [(&[[0, 1], [7, 1]][..], "there is no body 7"), (&[[1, 1]], "body 1 with itself")] {
        let told = leave_out(&mut all, pairs);
        refused(told, NearmissCode::NEARMISS_INVALID_ARGUMENT, says);
        assert_eq!(left_out(&mut all), [[0, 2], [1, 2]]);
    }
    assert_eq!(leave_out(&mut all, &[]), Ok(()));
    assert_eq!(rows(&mut all), whole);
    // A scene takes a list until a detector has copied it.
    let (device, mut scene) = (device(), scene(&bodies));
    let pair = [0u32, 1];
    // SAFETY: two numbers are there; so below.
    let listed = told(|e| unsafe { nearmiss_scene_leave_out(Some(&mut scene), pair.as_ptr(), 1, e) });
    assert_eq!(listed, Ok(()));
    let mut less_one = own(got(|made, e| nearmiss_detector_create(Some(&device), Some(&scene), made, e)));
    assert_eq!(rows(&mut less_one), less(&[[0, 1]]));
    // SAFETY: as above.
    let late = told(|e| unsafe { nearmiss_scene_leave_out(Some(&mut scene), pair.as_ptr(), 1, e) });
    let says = "which would not see the list; call nearmiss_detector_leave_out";
    refused(late, NearmissCode::NEARMISS_INVALID_ARGUMENT, says);
    // SAFETY: NULL is refused before anything is read.
    let null = told(|e| unsafe { nearmiss_detector_leave_out(Some(&mut less_one), std::ptr::null(), 1, e) });
    refused(null, NearmissCode::NEARMISS_INVALID_ARGUMENT, "pairs is NULL");
}
