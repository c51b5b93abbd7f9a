//! Whole numbers.

use clap::builder::{StringValueParser, TypedValueParser};

/// Takes a whole number from `least` to `most`; anything else is refused in our words.
pub fn whole<T>(least: u64, most: u64) -> impl TypedValueParser<Value = T>
where
    T: TryFrom<u64> + Clone + Send + Sync + 'static,
{
    StringValueParser::new().try_map(move |text: String| {
        let number = text.parse().ok().filter(|n| (least..=most).contains(n));
        number.and_then(|n| T::try_from(n).ok()).ok_or_else(|| match most {
            u64::MAX => format!("give a whole number from {least}"),
            _ => format!("give a whole number from {least} to {most}"),
        })
    })
}

/// A finite number above 0.
pub fn above_zero() -> impl TypedValueParser<Value = f64> {
    StringValueParser::new().try_map(|text: String| {
        let number = text.parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite());
        number.ok_or("give a number above 0")
    })
}

/// A number of things, at least one.
pub fn some<T>() -> impl TypedValueParser<Value = T>
where
    T: TryFrom<u64> + Clone + Send + Sync + 'static,
{
    whole(1, u64::from(u32::MAX))
}
