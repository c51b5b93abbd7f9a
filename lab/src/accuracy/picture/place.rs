//! Places names next to crowded marks: each in the nearest free place. A name that is not adjacent
//! to its mark has a line to it. No name covers a mark, another name or a line.

use crate::tables::picture::width;

/// A rectangle in pixels, from the upper left to the lower right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    /// Left and top.
    pub low: [i32; 2],
    /// Right and bottom.
    pub high: [i32; 2],
}

impl Area {
    /// Returns the square around a point.
    pub fn around([x, y]: [i32; 2], half: i32) -> Area {
        Area { low: [x - half, y - half], high: [x + half, y + half] }
    }

    fn meets(&self, other: &Area) -> bool {
        (0..2).all(|k| self.low[k] < other.high[k] && other.low[k] < self.high[k])
    }

    fn holds(&self, other: &Area) -> bool {
        (0..2).all(|k| self.low[k] <= other.low[k] && other.high[k] <= self.high[k])
    }

    /// Returns whether a line passes through it.
    fn is_crossed(&self, [from, to]: [[i32; 2]; 2]) -> bool {
        (0..=32).any(|part| {
            let at = [0, 1].map(|k| from[k] + (to[k] - from[k]) * part / 32);
            (0..2).all(|k| self.low[k] < at[k] && at[k] < self.high[k])
        })
    }
}

/// Place of a name: its area, and the line to its mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Area of the text.
    pub area: Area,
    /// Line from the mark to the text.
    pub line: Option<[[i32; 2]; 2]>,
}

/// Height of a name, and its font size.
const HEIGHT: i32 = 14;
pub const SIZE: i32 = 11;
/// Distances from a mark to try, in pixels; the first one needs no line.
const APART: [i32; 10] = [9, 18, 28, 38, 50, 64, 80, 98, 118, 140];
/// Directions to try, in hundredths.
const AROUND: [[i32; 2]; 14] = [
    [100, 0],
    [-100, 0],
    [94, -34],
    [94, 34],
    [-94, -34],
    [-94, 34],
    [77, -64],
    [77, 64],
    [-77, -64],
    [-77, 64],
    [34, -94],
    [34, 94],
    [-34, -94],
    [-34, 94],
];

/// Returns places inside `frame` for the names of marks, in their order; `None` for a name without
/// a free place. `marks` has the areas of all marks. Names compete for places, so three orders are
/// tried: from the first, from the last, and from the left.
pub fn places(names: &[([i32; 2], String)], marks: &[Area], frame: &Area) -> Vec<Option<Place>> {
    let mut orders: [Vec<usize>; 3] = std::array::from_fn(|_| (0..names.len()).collect());
    orders[1].reverse();
    orders[2].sort_by_key(|at| names[*at].0);
    let tried = orders.map(|order| {
        let sorted: Vec<([i32; 2], String)> = order.iter().map(|at| names[*at].clone()).collect();
        let mut found = vec![None; names.len()];
        order.iter().zip(one_by_one(&sorted, marks, frame)).for_each(|(at, place)| found[*at] = place);
        found
    });
    let left_out = |all: &Vec<Option<Place>>| all.iter().filter(|place| place.is_none()).count();
    tried.into_iter().min_by_key(left_out).unwrap_or_default()
}

fn one_by_one(names: &[([i32; 2], String)], marks: &[Area], frame: &Area) -> Vec<Option<Place>> {
    let mut all: Vec<Option<Place>> = Vec::new();
    for (mark, name) in names {
        let wide = width(name, SIZE);
        let tried =
            APART.iter().flat_map(|apart| AROUND.map(|[x, y]| [x * apart / 100, y * apart / 100, *apart]));
        let place = |[x, y, apart]: [i32; 3]| {
            let end = [mark[0] + x, mark[1] + y];
            let left = if x > 0 { end[0] + 2 } else { end[0] - 2 - wide };
            let area = Area { low: [left, end[1] - HEIGHT / 2], high: [left + wide, end[1] + HEIGHT / 2] };
            Place { area, line: (apart > APART[0]).then_some([*mark, end]) }
        };
        let is_free = |place: &Place, through: bool| {
            let own = |area: &&Area| !area.is_crossed([*mark, *mark]);
            frame.holds(&place.area)
                && !marks.iter().any(|other| other.meets(&place.area))
                && (through
                    || place.line.is_none_or(|line| !marks.iter().filter(own).any(|of| of.is_crossed(line))))
                && all.iter().flatten().all(|other| {
                    !other.area.meets(&place.area)
                        && other.line.is_none_or(|line| !place.area.is_crossed(line))
                        && place.line.is_none_or(|line| !other.area.is_crossed(line))
                        && !place.line.zip(other.line).is_some_and(|(a, b)| cross(a, b))
                })
        };
        // In a crowd a line may begin below other marks.
        let find = |through: bool| tried.clone().map(place).find(|place| is_free(place, through));
        let found = find(false).or_else(|| find(true));
        all.push(found);
    }
    all
}

/// Returns whether two lines cross.
fn cross([a, b]: [[i32; 2]; 2], [c, d]: [[i32; 2]; 2]) -> bool {
    let side = |p: [i32; 2], q: [i32; 2], r: [i32; 2]| {
        ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).signum()
    };
    side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the faults of places: names over names, over marks and over lines.
    fn faults(places: &[Place], marks: &[Area]) -> Vec<(usize, &'static str)> {
        let mut found = Vec::new();
        for (at, one) in places.iter().enumerate() {
            if places[at + 1..].iter().any(|other| other.area.meets(&one.area)) {
                found.push((at, "a name"));
            }
            if marks.iter().any(|mark| mark.meets(&one.area)) {
                found.push((at, "a mark"));
            }
            if places.iter().filter_map(|other| other.line).any(|line| one.area.is_crossed(line)) {
                found.push((at, "a line"));
            }
        }
        found
    }

    #[test]
    fn names_of_a_crowd_stand_apart() {
        let frame = Area { low: [0, 0], high: [600, 220] };
        let names: Vec<([i32; 2], String)> =
            (0..12).map(|k| ([250 + 12 * (k % 5), 60 + 8 * k], format!("certified-f32 1e-{k}"))).collect();
        let marks: Vec<Area> = names.iter().map(|(at, _)| Area::around(*at, 5)).collect();
        let found: Vec<Place> = places(&names, &marks, &frame).into_iter().flatten().collect();
        assert!(found.len() == 12, "{} of 12 names have a place", found.len());
        assert_eq!(faults(&found, &marks), []);
        assert!(found.iter().all(|place| frame.holds(&place.area)));
        // The checker must notice a name over a name, and one over a mark.
        let mut bad = found.clone();
        bad[2].area = bad[7].area;
        assert!(faults(&bad, &marks).contains(&(2, "a name")));
        bad[2].area = Area::around(names[0].0, 9);
        assert!(faults(&bad, &marks).contains(&(2, "a mark")));
    }

    #[test]
    fn names_give_way_to_others() {
        // The first name would cover the second, which has no other place.
        let frame = Area { low: [0, 0], high: [260, 60] };
        let names =
            [([60, 50], "cubic-f64: 0 + 0".to_owned()), ([20, 50], "certified-f64 1e-4 linear".to_owned())];
        let marks: Vec<Area> = names.iter().map(|(at, _)| Area::around(*at, 5)).collect();
        let found: Vec<Place> = places(&names, &marks, &frame).into_iter().flatten().collect();
        assert_eq!((found.len(), faults(&found, &marks)), (2, vec![]));
    }

    #[test]
    fn a_name_alone_stands_beside_its_mark() {
        let frame = Area { low: [0, 0], high: [600, 220] };
        let place = |x: i32| {
            let names = [([x, 100], "exact".to_owned())];
            places(&names, &[Area::around([x, 100], 5)], &frame)[0].expect("there is room")
        };
        assert!(place(300).line.is_none() && place(300).area.low[0] == 311);
        assert!(place(595).area.high[0] < 595);
        assert_eq!(places(&[([5, 5], "too long".repeat(100))], &[], &frame), [None]);
    }
}
