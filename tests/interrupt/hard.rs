//! Hard scenes, whose launches and blocks are long: they end soon after a trigger all the same.

use super::threads;
use nearmiss::research::{BroadPhase, QueryExt};
use nearmiss::{Body, Error, Query};
use nearmiss_lab::OneQuery;
use std::time::{Duration, Instant};
use support::{cases, moving};

/// A machine with much else to do takes longer; without an interrupt these take seconds to minutes.
const SOON: Duration = Duration::from_secs(2);

fn loose(t0: &[[f32; 3]], by: impl Fn(usize, [f32; 3]) -> [f32; 3]) -> Body {
    let t1: Vec<_> = t0.iter().enumerate().map(|(i, p)| by(i / 3, *p)).collect();
    let faces: Vec<_> = (0..t0.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    moving(t0, &t1, &faces)
}

/// Equal triangles that slide in their plane, each by itself.
fn equal(n: usize) -> Body {
    let t0 = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].repeat(n);
    loose(&t0, |i, [x, y, z]| [x + i as f32 / 1024.0, y + 0.25, z])
}

/// Triangles on one line, which move along it.
fn collinear(n: usize) -> Body {
    let triangle = |i: usize| [0.0, 0.5, 1.0].map(|x| [x + i as f32 / 64.0, 0.0, 0.0]);
    let t0: Vec<_> = (0..n).flat_map(triangle).collect();
    loose(&t0, |i, [x, y, z]| [x + if i % 2 == 0 { 3.0 } else { -3.0 }, y, z])
}

/// A fan whose hub is two vertices in one place, in turns.
fn fan(n: u32) -> Body {
    let rim = |i: u32| {
        let t = i as f32 / n as f32;
        [t, 1.0 - t * t, (i % 7) as f32 / 64.0]
    };
    let t0: Vec<_> = [[0.0; 3]; 2].into_iter().chain((0..=n).map(rim)).collect();
    let t1: Vec<_> = t0.iter().map(|[x, y, z]| [*x, *y, -z]).collect();
    let faces: Vec<_> = (0..n).map(|i| [i % 2, 2 + i, 3 + i]).collect();
    moving(&t0, &t1, &faces)
}

/// How long a call goes on behind a trigger that comes in the middle of it.
fn latency(body: &Body, query: Query, after: Duration) -> Duration {
    let mut own = OneQuery::new(threads(2), body.clone(), query).expect("a detector");
    let interrupt = own.interrupter();
    let thread = std::thread::spawn(move || {
        std::thread::sleep(after);
        let at = Instant::now();
        interrupt.trigger();
        at
    });
    let ended = std::iter::repeat_with(|| own.detect()).find_map(Result::err);
    let end = Instant::now();
    assert!(matches!(ended, Some(Error::Interrupted)), "{ended:?}");
    end - thread.join().expect("no panic")
}

#[test]
fn hard_scenes_end_soon() {
    let scenes = [("equal", equal(500)), ("collinear", collinear(300)), ("fan", fan(3_000))];
    for (scene, (name, body)) in scenes.iter().enumerate() {
        let far = Query::near(100.0);
        let queries = [Query::continuous(), Query::earliest(), Query::discrete(), far];
        for (turn, query) in (scene..).zip(queries) {
            for (turn, broad) in (turn..).zip([BroadPhase::Tiles, BroadPhase::Tree]) {
                // Both times take turns.
                for after in [20, 300].into_iter().cycle().skip(turn % 2).take(cases(1, 2)) {
                    let took = latency(body, query.with_broad_phase(broad), Duration::from_millis(after));
                    println!("{name}, {}, {broad:?}: {took:?} after {after} ms", query.kind());
                    assert!(took < SOON, "{name}, {query:?}: {took:?}");
                }
            }
        }
    }
}
