//! Words of messages.

/// A number of things: `1 pair`, `2 pairs`.
pub fn counted(n: u64, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_singular() {
        let of = |n| counted(n, "vertex", "vertices");
        assert_eq!([of(0), of(1), of(2)], ["0 vertices", "1 vertex", "2 vertices"]);
    }
}
