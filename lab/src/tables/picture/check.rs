//! Checks a picture's SVG for texts over each other, or beyond the sheet.

/// A text and its smallest rectangle in a usual font: left, top, right, bottom.
struct Text {
    text: String,
    area: [f64; 4],
}

fn attribute(tag: &str, name: &str) -> String {
    let rest = tag.split(&format!(" {name}=\"")).nth(1).unwrap_or_default();
    rest.split('"').next().unwrap_or_default().to_owned()
}

fn texts(svg: &str) -> Vec<Text> {
    let one = |part: &str| {
        let (tag, rest) = part.split_once('>').expect("a tag");
        let text = rest.split("</text>").next().unwrap_or_default().trim().to_owned();
        let [x, y, size] =
            ["x", "y", "font-size"].map(|name| attribute(tag, name).parse::<f64>().expect("a number"));
        let wide = 0.54 * size * text.replace("&lt;", "<").replace("&gt;", ">").chars().count() as f64;
        let left = match attribute(tag, "text-anchor").as_str() {
            "middle" => x - wide / 2.0,
            "end" => x - wide,
            _ => x,
        };
        Text { text, area: [left, y - 0.45 * size, left + wide, y + 0.45 * size] }
    };
    svg.split("<text").skip(1).map(|part| one(&format!(" {part}"))).collect()
}

/// Returns the faults of a picture's texts, in words.
pub fn faults(svg: &str) -> Vec<String> {
    let all = texts(svg);
    assert!(!all.is_empty(), "a picture has texts");
    let sheet = [attribute(svg, "width"), attribute(svg, "height")]
        .map(|side| side.parse::<f64>().expect("a number"));
    let mut found = Vec::new();
    for (at, one) in all.iter().enumerate() {
        let [left, top, right, bottom] = one.area;
        if left < 0.0 || top < 0.0 || right > sheet[0] || bottom > sheet[1] {
            found.push(format!("{} is not all on the sheet", one.text));
        }
        for other in &all[at + 1..] {
            let apart = other.area[0] >= right
                || other.area[2] <= left
                || other.area[1] >= bottom
                || other.area[3] <= top;
            if !apart {
                found.push(format!("{} is over {}", one.text, other.text));
            }
        }
    }
    found
}

#[test]
fn texts_over_each_other_are_named() {
    use super::{At, INK, sheet};
    let svg = |second: (i32, i32)| {
        sheet(100, |sheet| {
            sheet.text("the one", (20, 20), 12, At::Left, INK)?;
            sheet.text("the other", second, 12, At::Left, INK)
        })
        .expect("a picture")
    };
    assert_eq!(faults(&svg((20, 34))), Vec::<String>::new());
    assert_eq!(faults(&svg((40, 24))), ["the one is over the other"]);
    assert_eq!(faults(&svg((870, 24))), ["the other is not all on the sheet"]);
}
