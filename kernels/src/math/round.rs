//! Outward rounding: from a coordinate as given to the f32 bound of a box.

/// The largest f32 that is not above `x`. Exact f32 values stay themselves.
pub fn down(x: f64) -> f32 {
    let y = x as f32;
    if y as f64 > x { y.next_down() } else { y }
}

/// The smallest f32 that is not below `x`. Exact f32 values stay themselves.
pub fn up(x: f64) -> f32 {
    let y = x as f32;
    if (y as f64) < x { y.next_up() } else { y }
}
