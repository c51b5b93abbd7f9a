//! In every volume: other orders, other units, mirrors, another origin, the end of the step for its beginning.

use super::*;
use support::asked::of;

/// The answer in that volume.
fn dressed(body: &Body, motion: QueryKind, volume: BoundingVolume) -> Contacts {
    ask(engine(), vec![body.clone()], of(motion).with_volume(volume))
}

/// Each change of a body leaves the same contacts, those of the default volume, in every volume.
#[test]
fn every_volume_leaves_the_contacts_as_they_are() {
    let mut bodies = moving_scenes();
    bodies.extend(still_scenes());
    for body in bodies {
        let motion = if body.is_moving() { QueryKind::Continuous } else { QueryKind::Discrete };
        let truth = found(std::slice::from_ref(&body), motion);
        let scaled = mapped(&body, |p| p.map(|x| x * 8192.0));
        let through = mapped(&body, |p| p.map(|x| -x));
        let mirrored = mapped(&body, |p| [p[0], -p[1], p[2]]);
        let backwards = changed(&body, body.faces().iter().rev().copied().collect(), |points| points);
        for volume in BoundingVolume::ALL {
            let name = format!("{}, {}", body.name(), volume.name());
            for (what, other) in [("as it is", &body), ("scaled", &scaled), ("through the origin", &through)]
            {
                assert_eq!(dressed(other, motion, volume).rows, truth.rows, "{name}, {what}");
            }
            let (other, last) = (dressed(&backwards, motion, volume), body.face_count() as u32 - 1);
            if motion == QueryKind::Discrete {
                assert_eq!(dressed(&mirrored, motion, volume).rows, truth.rows, "{name}, mirrored");
                let turn = |[a, b]: &[u32; 2]| [last - b, last - a];
                let mut pairs: Vec<[u32; 2]> = other.triangles().iter().map(turn).collect();
                pairs.sort_unstable();
                assert_eq!(pairs, truth.triangles(), "{name}, backwards");
            } else {
                let known = named(&body, truth.contacts(), |v| v);
                let again = dressed(&mirrored, motion, volume);
                assert_close(&named(&mirrored, again.contacts(), |v| v), &known, &name);
                assert_eq!(named(&backwards, other.contacts(), |v| v), known, "{name}, backwards");
            }
        }
    }
}

/// Features that are certain to meet do so too when the step is run backwards, in every volume.
#[test]
fn backwards_in_time_the_same_features_meet() {
    for body in moving_scenes() {
        let frames = body.frames();
        let back = Body::moving(frames[1].clone(), frames[0].clone()).expect("two frames");
        let sure = |contacts: &Contacts| -> Vec<Named> {
            let certified = contacts.contacts().iter().filter(|c| c.status == Status::Certified);
            let certified: Vec<Contact> = certified.copied().collect();
            named(&body, &certified, |v| v).into_keys().collect()
        };
        for volume in BoundingVolume::ALL {
            let (there, here) = (
                dressed(&body, QueryKind::Continuous, volume),
                dressed(&back, QueryKind::Continuous, volume),
            );
            let all = |contacts: &Contacts| named(&body, contacts.contacts(), |v| v);
            for (one, other) in [(&there, &here), (&here, &there)] {
                let listed = all(other);
                let lost = sure(one).into_iter().find(|name| !listed.contains_key(name));
                assert_eq!(lost, None, "{}, {}", body.name(), volume.name());
            }
            assert!(!sure(&there).is_empty());
        }
    }
}
