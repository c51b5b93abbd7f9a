//! The horizon of an earliest query: the time until which a pair matters.

use crate::abi::Span;
use crate::bv::Volume;
use crate::exec::Block;
use crate::math::round;
use crate::math::tolerance::HORIZON_MARGIN;

/// The end of the step, or a time before it: no verdict of a pair whose boxes first overlap behind
/// it begins before the time that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Horizon(f32);

impl Horizon {
    /// By the bits of a time that is known, of an earlier launch: NaN for none, or no memory.
    #[inline(always)]
    pub fn of<B: Block>(block: &B, known: Span<u64>) -> Horizon {
        Horizon::behind(if known.is_empty() { f64::NAN } else { f64::from_bits(block.load(known, 0)) })
    }
    /// Behind a time.
    #[inline(always)]
    pub fn behind(known: f64) -> Horizon {
        let time = round::up(known + HORIZON_MARGIN);
        Horizon(if time < 1.0 { time } else { 1.0 })
    }
    /// A time in (0, 1].
    #[inline(always)]
    pub fn time(self) -> f32 {
        self.0
    }
    /// A volume until the horizon, if there is one.
    #[inline(always)]
    pub fn cut<const THERE: bool, V: Volume>(self, volume: V) -> V {
        if THERE && self.0 < 1.0 { volume.until(self.0) } else { volume }
    }
}
