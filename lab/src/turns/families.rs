//! Families of hostile pairs of turning features.

use super::build::{Body, Choice, Meeting, Point, cross, dot, length, meeting, pair, plus, times, unit};
use crate::oracle::turning::Pair;
use crate::scene::rng::Rng;

/// Names of the families.
pub const FAMILIES: [&str; 25] = [
    "generic",
    "near miss",
    "bar and peg",
    "large radius",
    "tangent",
    "coin",
    "gears",
    "at the start",
    "to 350 degrees",
    "tiny angles",
    "turntable",
    "borders",
    "far from the origin",
    "at the end",
    "in one plane",
    "mixed sizes",
    "deformable",
    "deformable tangent",
    "does not turn",
    "same pivot",
    "sliding edges",
    "separation",
    "separation tangent",
    "separation deformable",
    "slow on borders",
];

/// A pair of a family.
pub struct Case {
    /// The pair.
    pub pair: Pair,
    /// Its tolerance.
    pub tolerance: f64,
    /// Its separation.
    pub separation: f64,
    /// The time for which it was built.
    pub t: f64,
    /// The gap at that time.
    pub gap: f64,
    /// Whether it was built inside both features, not in one plane.
    pub is_inside: bool,
}

/// The plan of a pair: two bodies, and the place where they meet.
struct Plan {
    bodies: [Body; 2],
    m: Meeting,
    separation: f64,
}

/// A body that deforms, with the pivot of another.
fn deformable(r: &mut Choice, near: &Body, differ: f64) -> Body {
    let speed = times(r.between(0.0, 1.0), r.direction());
    Body { phi: [0.0; 3], pivot: near.pivot, speed: Some((speed, differ)) }
}

/// A body that does not move.
fn fixed(near: &Body) -> Body {
    Body { phi: [0.0; 3], pivot: near.pivot, speed: Some(([0.0; 3], 0.0)) }
}

/// The `i`th pair of a family, for a seed; half of them are edges.
pub fn case(seed: u64, family: usize, i: u64) -> Case {
    let mixed = seed.wrapping_mul(1_000_003) ^ (family as u64) << 40 ^ i.wrapping_mul(15_485_863);
    let mut r = Choice(Rng::new(mixed));
    let is_face = i.is_multiple_of(2);
    let mut plan = plan(&mut r, family, is_face);
    let swap = !is_face && r.once_in(2);
    let slides = FAMILIES[family] == "sliding edges";
    let mut built = match FAMILIES[family] {
        "borders" | "sliding edges" if !is_face && (slides || r.once_in(2)) => {
            parallel(&mut r, &plan, slides)
        }
        _ => meeting(&mut r, is_face, &plan.bodies, &plan.m),
    };
    if FAMILIES[family] == "in one plane" {
        for side in &mut built.sides {
            side.points = side.points.map(|p| p.map(|[x, y, _]| [x, y, 0.0]));
        }
    }
    if swap {
        built.sides.reverse();
    }
    let size = plan.m.sizes[0].max(plan.m.sizes[1]).max(plan.separation);
    let tolerance = size * [1e-3, 1e-4, 1e-5, 1e-6, 1e-10, 0.0][r.of(6) as usize];
    let is_inside = plan.m.border > 0 && !matches!(FAMILIES[family], "in one plane" | "sliding edges");
    plan.m.gap -= plan.separation;
    Case { pair: built, tolerance, separation: plan.separation, t: plan.m.t, gap: plan.m.gap, is_inside }
}

/// Nearly parallel edges through one place.
fn parallel(r: &mut Choice, plan: &Plan, slides: bool) -> Pair {
    let (m, e) = (&plan.m, r.direction());
    let p = r.across(e);
    let differ = if r.once_in(3) { 0.0 } else { r.power(-10.0, -1.0) };
    let gap = if slides { r.power(-14.0, -3.0) } else { m.gap };
    let (other, o) = (plus(e, differ, p), times(gap, cross(e, p)));
    let b = plus(m.at, 1.0, o);
    let ends = |at: Point, d: Point, [x, y]: [f64; 2]| [plus(at, x, d), plus(at, y, d), at];
    let points = [ends(m.at, e, [-0.4, 0.6]), ends(b, other, [-0.3, 0.7])];
    pair(r, false, &plan.bodies, m.t, &points)
}

fn plan(r: &mut Choice, family: usize, is_face: bool) -> Plan {
    let pi = std::f64::consts::PI;
    let mut bodies = [(); 2].map(|()| {
        let (angle, travel) = (r.between(0.0, pi), r.between(0.0, 2.0));
        r.body(angle, travel)
    });
    let size = r.between(0.2, 1.5);
    let at = times(r.between(0.0, 3.0), r.direction());
    let m = Meeting {
        t: r.between(0.02, 0.98),
        at,
        normal: r.direction(),
        gap: 0.0,
        border: 1,
        sizes: [size; 2],
    };
    let mut plan = Plan { bodies, m, separation: 0.0 };
    let m = &mut plan.m;
    match FAMILIES[family] {
        "near miss" => m.gap = r.sign() * r.power(-12.0, -1.0),
        "bar and peg" => {
            bodies = [r.body(0.0, 0.0), r.body(pi, 0.0)];
            bodies[1].pivot = [[0.0; 3]; 2];
            let axis = unit(bodies[1].phi);
            m.at = plus(times(r.between(2.0, 5.0), r.across(axis)), r.between(-1.0, 1.0), axis);
            m.sizes = [r.between(2.0, 6.0); 2];
            m.normal = unit(bodies[1].velocity(m.t, m.at));
            m.gap = r.gap(-12.0, -1.0);
            if r.once_in(2) {
                bodies.reverse();
            }
        }
        "large radius" => {
            m.at = times(r.power(2.0, 4.0), r.direction());
            m.gap = r.gap(-9.0, -1.0);
            if r.once_in(2) {
                bodies[0] = r.body(0.0, 0.0);
                bodies[0].pivot = [m.at, plus(m.at, r.between(0.0, 1.0), r.direction())];
            }
        }
        "tangent" | "separation tangent" => {
            let turning = {
                let angle = r.power(-1.0, 0.49);
                r.body(angle, 0.0)
            };
            let axis = unit(turning.phi);
            let along = plus(turning.pivot[0], r.between(-0.3, 0.3), turning.phi);
            m.normal = r.across(axis);
            m.at = plus(along, r.between(0.5, 4.0), m.normal);
            m.gap = r.gap(-14.0, -2.0);
            bodies = [turning, fixed(&turning)];
            if r.once_in(2) {
                bodies[1] = r.body(0.0, 0.0);
            }
            if r.once_in(2) {
                bodies.reverse();
            }
        }
        "coin" => {
            let (radius, angle) = (r.between(0.5, 2.0), r.between(0.5, 6.0));
            let mut coin = Body {
                phi: [0.0, angle, 0.0],
                pivot: [[0.0, 0.0, radius], [radius * angle, 0.0, radius]],
                speed: None,
            };
            m.at = [radius * angle * m.t, 0.0, 0.0];
            m.normal = [0.0, 0.0, 1.0];
            m.gap = r.gap(-14.0, -2.0);
            if r.once_in(3) {
                coin.phi = plus(coin.phi, r.power(-8.0, -1.0), r.direction());
            }
            bodies = [coin, if r.once_in(2) { fixed(&coin) } else { r.body(0.0, 0.0) }];
            if r.once_in(2) {
                bodies.reverse();
            }
        }
        "gears" => {
            let (radius, angle) = (r.between(1.0, 2.0), r.power(-1.0, 0.49));
            let gear =
                |phi: f64, x: f64| Body { phi: [0.0, 0.0, phi], pivot: [[x, 0.0, 0.0]; 2], speed: None };
            bodies = [gear(angle, 0.0), gear(-angle, 2.0 * radius)];
            m.at = [radius + r.between(-0.1, 0.1), r.between(-0.1, 0.1), r.between(-1.0, 1.0)];
            let tilt = r.between(-0.6, 0.6);
            m.normal = unit([tilt.sin(), tilt.cos(), r.power(-8.0, -1.0)]);
            if r.once_in(2) {
                m.normal = [1.0, 0.0, 0.0];
            }
            m.gap = r.gap(-12.0, -2.0);
            m.sizes = [r.between(0.05, 0.3); 2];
        }
        "at the start" => {
            m.t = 0.0;
            m.gap = r.gap(-17.0, -6.0);
            m.border = r.of(3) as i32 - 1;
        }
        "to 350 degrees" => {
            bodies[0].phi = times(r.between(3.2, 6.1), r.direction());
            if r.once_in(2) {
                bodies[1].phi = times(r.between(3.2, 6.1), r.direction());
            }
            m.t = r.between(0.6, 0.98);
            m.gap = r.gap(-10.0, -2.0);
        }
        "tiny angles" => {
            let small =
                |r: &mut Choice| if r.once_in(8) { r.power(-17.0, -10.0) } else { r.power(-9.0, -3.0) };
            bodies[0].phi = times(small(r), r.direction());
            bodies[1].phi = times(if r.once_in(4) { 0.0 } else { r.power(-9.0, -3.0) }, r.direction());
            if r.once_in(2) {
                bodies[0].pivot[1] = plus(bodies[0].pivot[0], r.power(-9.0, -3.0), r.direction());
                bodies[1].pivot[1] = bodies[1].pivot[0];
            }
            m.gap = r.gap(-14.0, -5.0);
        }
        "turntable" => {
            bodies[0].phi = times(r.between(0.1, 6.1), r.direction());
            bodies[0].pivot[1] = if r.once_in(2) {
                plus(bodies[0].pivot[0], r.power(-9.0, -2.0), m.normal)
            } else {
                bodies[0].pivot[0]
            };
            bodies[1].phi = bodies[0].phi;
            bodies[1].pivot =
                [bodies[0].pivot[0], if r.once_in(2) { bodies[0].pivot[0] } else { bodies[0].pivot[1] }];
            m.gap = r.gap(-12.0, -2.0);
        }
        "borders" | "sliding edges" => {
            m.gap = if r.once_in(2) { 0.0 } else { r.sign() * r.power(-12.0, -3.0) };
            m.border = r.of(2) as i32 - 1;
            if FAMILIES[family] == "sliding edges" {
                // Both turn nearly together, so that the gap stays.
                let differ = r.power(-6.0, -1.0);
                bodies[1] = bodies[0];
                bodies[1].phi = plus(bodies[0].phi, differ, r.direction());
                bodies[1].pivot[1] = plus(bodies[0].pivot[1], differ, r.direction());
            }
        }
        "far from the origin" => {
            let o = times(r.power(5.0, 7.0), r.direction());
            for body in &mut bodies {
                body.pivot[0] = plus(o, 1.0, r.direction());
                body.pivot[1] = plus(body.pivot[0], 1.0, r.direction());
            }
            m.at = plus(o, 1.0, r.direction());
            m.gap = r.gap(-7.0, -1.0);
        }
        "at the end" => {
            m.t = 1.0;
            m.gap = r.gap(-12.0, -2.0);
        }
        "in one plane" => {
            let flat = |r: &mut Choice, angle: f64| {
                let pivot = [(); 2].map(|()| [r.between(-1.0, 1.0), r.between(-1.0, 1.0), 0.0]);
                Body { phi: [0.0, 0.0, angle], pivot, speed: None }
            };
            let angles = [r.between(0.1, 3.1), if r.once_in(2) { 0.0 } else { r.between(-3.0, 3.0) }];
            bodies = angles.map(|angle| flat(r, angle));
            let up = if r.once_in(2) { 0.0 } else { r.sign() * r.power(-12.0, -2.0) };
            bodies[1].pivot = [[0.0, 0.0, up]; 2];
            m.at = [r.between(-2.0, 2.0), r.between(-2.0, 2.0), 0.0];
            m.normal = [0.0, 0.0, 1.0];
            m.border = r.of(3) as i32 - 1;
        }
        "mixed sizes" => {
            m.sizes = [r.power(-4.0, 3.0), r.power(-4.0, 3.0)];
            m.gap = r.gap(-12.0, -2.0);
        }
        "deformable" | "separation deformable" => {
            let differ = if r.once_in(4) { 0.0 } else { r.power(-3.0, 0.3) };
            bodies[1] = deformable(r, &bodies[0], differ);
            m.gap = r.gap(-12.0, -1.0);
            if r.once_in(2) {
                bodies.reverse();
            }
        }
        "deformable tangent" => {
            // The normal is across the velocity between both: the gap opens again, or closes.
            let differ = r.power(-6.0, -1.0);
            bodies[1] = deformable(r, &bodies[0], differ);
            let speed = bodies[1].speed.map_or([0.0; 3], |s| s.0);
            let v = plus(bodies[0].velocity(m.t, m.at), -1.0, speed);
            if length(v) > 1e-3 {
                m.normal = r.across(unit(v));
            }
            m.gap = r.gap(-14.0, -2.0);
            if r.once_in(2) {
                bodies.reverse();
            }
        }
        "does not turn" => {
            bodies[1] = deformable(r, &bodies[0], 0.0);
            m.gap = r.gap(-12.0, -1.0);
            if r.once_in(2) {
                bodies.reverse();
            }
        }
        "same pivot" => {
            bodies[1].pivot = bodies[0].pivot;
            if r.once_in(2) {
                bodies[1].phi =
                    plus(times(r.between(-1.0, 1.0), bodies[0].phi), r.power(-12.0, -1.0), r.direction());
            }
            if r.once_in(2) {
                // The normal points to the common centre: the gap stays.
                let centre = bodies[0].pivot_at(m.t);
                m.normal = unit(plus(m.at, -1.0, centre));
            }
            m.gap = r.gap(-12.0, -1.0);
        }
        "separation" => m.gap = r.gap(-12.0, -1.0),
        "slow on borders" => {
            // Along the plane fast, through it slowly: the root is not well known.
            let v = plus(bodies[0].velocity(m.t, m.at), -1.0, bodies[1].velocity(m.t, m.at));
            m.normal = unit(plus(r.across(unit(v)), r.power(-7.0, -2.0), unit(v)));
            m.border = 0;
        }
        _ => {}
    }
    if FAMILIES[family].starts_with("separation") {
        plan.separation = r.power(-4.0, 0.0);
        m.gap = plan.separation + if m.gap.abs() < plan.separation { m.gap } else { 0.0 };
    }
    debug_assert!(dot(m.normal, m.normal) > 0.9 || is_face);
    plan.bodies = bodies;
    plan
}
