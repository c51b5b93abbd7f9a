//! Machine code of the kernels, in addition to the PTX. A release has a file of it, which
//! `.ci/cubins.sh` makes from the PTX; a build from source has none. build.rs reads the file by
//! these lines too.
//!
//! The file is a text that ends with an empty line, then one zstd frame after the other:
//!
//! ```text
//! nearmiss machine code 1
//! ptx SHA-256 of the PTX file
//! code SHA-256 of all frames
//! assembler its version
//! 90 narrow_filter_f32 64 5120     compute capability, kernel, limit of registers (0: none), bytes
//! ```

const MAGIC: &str = "nearmiss machine code 1";

/// A file of machine code, or nothing.
#[derive(Default)]
pub struct Cubins<'a> {
    /// Digest of the PTX file that it was made from.
    ptx: &'a str,
    /// Digest of the frames.
    code: &'a str,
    frames: &'a [u8],
    lines: Vec<Line<'a>>,
}

/// Major and minor number of a compute capability.
pub type Capability = (i32, i32);

/// A kernel for an architecture.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Line<'a> {
    made_for: Capability,
    kernel: &'a str,
    registers: Option<u32>,
    packed: &'a [u8],
}

impl<'a> Cubins<'a> {
    /// Reads a file. An empty one has no code.
    ///
    /// # Errors
    /// The reason why it is not one, or not a whole one.
    pub fn new(file: &'a [u8]) -> Result<Cubins<'a>, String> {
        if file.is_empty() {
            return Ok(Cubins::default());
        }
        let end = file.windows(2).position(|two| two == b"\n\n").ok_or("its text has no end")?;
        let (text, frames) = (&file[..end], &file[end + 2..]);
        let text = std::str::from_utf8(text).map_err(|_| "its first lines are not a text")?;
        let mut lines = text.lines();
        if lines.next() != Some(MAGIC) {
            return Err(format!("its first line is not `{MAGIC}`"));
        }
        let mut named = |name: &str| {
            let line = lines.next().unwrap_or_default();
            let value = line.strip_prefix(name).and_then(|rest| rest.strip_prefix(' '));
            value.ok_or_else(|| format!("a line `{name} …` is missing, got `{line}`"))
        };
        let (ptx, code, _) = (named("ptx")?, named("code")?, named("assembler")?);
        let mut rest = frames;
        let lines = lines.map(|line| {
            let (line, bytes) = read(line).ok_or_else(|| format!("not a line of a kernel: `{line}`"))?;
            let (packed, behind) = rest
                .split_at_checked(bytes)
                .ok_or_else(|| format!("it ends within the code of {}", line.kernel))?;
            rest = behind;
            Ok(Line { packed, ..line })
        });
        let lines = lines.collect::<Result<_, String>>()?;
        if !rest.is_empty() {
            return Err(format!("{} bytes of its code belong to no kernel", rest.len()));
        }
        Ok(Cubins { ptx, code, frames, lines })
    }

    /// Checks that it was made from a PTX file and that no byte has changed.
    ///
    /// # Errors
    /// The difference.
    pub fn matches(&self, ptx: &str, digest: impl Fn(&[u8]) -> String) -> Result<(), String> {
        if self.ptx != ptx {
            return Err(format!("it was made from another PTX: {}, and this is {ptx}", self.ptx));
        }
        let found = digest(self.frames);
        if self.code != found {
            return Err(format!("its code is damaged: digest {found}, its text has {}", self.code));
        }
        Ok(())
    }

    /// Whether it has code that a GPU of this compute capability runs.
    pub fn covers(&self, gpu: Capability) -> bool {
        self.lines.iter().any(|line| runs(line.made_for, gpu))
    }

    /// The packed code of a kernel with this limit of registers, and the compute capability that it
    /// was made for: the newest that the GPU runs.
    pub fn choose(
        &self,
        gpu: Capability,
        kernel: &str,
        registers: Option<u32>,
    ) -> Option<(Capability, &'a [u8])> {
        let fits =
            |line: &&Line| line.kernel == kernel && line.registers == registers && runs(line.made_for, gpu);
        let best = self.lines.iter().filter(fits).max_by_key(|line| line.made_for)?;
        Some((best.made_for, best.packed))
    }
}

/// Whether a GPU runs machine code that was made for another: the major number is the same, and the
/// minor one is not lower (CUDA C++ Programming Guide, "Binary Compatibility").
fn runs(made_for: Capability, gpu: Capability) -> bool {
    made_for.0 == gpu.0 && made_for.1 <= gpu.1
}

/// A kernel's line, still without its code, and the number of bytes of that.
fn read(line: &str) -> Option<(Line<'_>, usize)> {
    let mut words = line.split(' ');
    let (number, kernel) = (words.next()?.parse::<i32>().ok()?, words.next()?);
    let (registers, bytes) = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
    let made_for = (number / 10, number % 10);
    let line = Line { made_for, kernel, registers: Some(registers).filter(|n| *n > 0), packed: &[] };
    words.next().is_none().then_some((line, bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "nearmiss machine code 1\nptx abc\ncode 6:21\nassembler 12.9.86\n\
        80 one 0 1\n86 one 0 2\n90 one 0 1\n90 two 64 2\n\n";
    const CODE: [u8; 6] = [1, 2, 3, 4, 5, 6];

    /// Length and sum, in place of a digest.
    fn sum(bytes: &[u8]) -> String {
        format!("{}:{}", bytes.len(), bytes.iter().map(|byte| u32::from(*byte)).sum::<u32>())
    }

    fn file(text: &str, code: &[u8]) -> Vec<u8> {
        [text.as_bytes(), code].concat()
    }

    fn reason(file: &[u8]) -> String {
        let read = Cubins::new(file).and_then(|cubins| cubins.matches("abc", sum));
        read.expect_err("a planted fault")
    }

    #[test]
    fn a_gpu_gets_the_newest_code_that_it_runs() {
        let whole = file(TEXT, &CODE);
        let cubins = Cubins::new(&whole).expect("a file");
        cubins.matches("abc", sum).expect("made from it, and whole");
        let one = |gpu| cubins.choose(gpu, "one", None);
        assert_eq!(one((8, 0)), Some(((8, 0), &CODE[..1])));
        for newer in [(8, 6), (8, 7), (8, 9)] {
            assert_eq!(one(newer), Some(((8, 6), &CODE[1..3])), "{newer:?}");
        }
        assert_eq!(one((9, 0)), Some(((9, 0), &CODE[3..4])));
        assert_eq!(cubins.choose((9, 0), "two", Some(64)), Some(((9, 0), &CODE[4..])));
    }

    #[test]
    fn code_for_another_gpu_kernel_or_limit_is_not_taken() {
        let whole = file(TEXT, &CODE);
        let cubins = Cubins::new(&whole).expect("a file");
        // Older and unknown ones, and a kernel that is there for another architecture only.
        for unknown in [(7, 5), (10, 0), (12, 1)] {
            assert!(cubins.choose(unknown, "one", None).is_none() && !cubins.covers(unknown), "{unknown:?}");
        }
        assert!(cubins.covers((9, 0)) && cubins.choose((8, 0), "two", Some(64)).is_none());
        // Code for 8.6 does not run on 8.0.
        let newer = file(&TEXT.replace("80 one", "86 one"), &CODE);
        assert!(Cubins::new(&newer).expect("a file").choose((8, 0), "one", None).is_none());
        for limit in [None, Some(80)] {
            assert!(cubins.choose((9, 0), "two", limit).is_none(), "{limit:?}");
        }
        assert!(cubins.choose((9, 0), "three", None).is_none());
        let none = Cubins::new(&[]).expect("nothing");
        assert!(none.choose((9, 0), "one", None).is_none() && !none.covers((9, 0)));
    }

    #[test]
    fn code_of_another_ptx_is_refused() {
        let other = reason(&file(&TEXT.replace("ptx abc", "ptx abd"), &CODE));
        assert_eq!(other, "it was made from another PTX: abd, and this is abc");
    }

    #[test]
    fn a_damaged_file_is_refused() {
        let whole = file(TEXT, &CODE);
        // Wherever it is cut, except to nothing.
        for end in 1..whole.len() {
            assert!(!reason(&whole[..end]).is_empty(), "{end}");
        }
        assert_eq!(reason(&whole[..whole.len() - 1]), "it ends within the code of two");
        assert_eq!(reason(&[&whole[..], &[7]].concat()), "1 bytes of its code belong to no kernel");
        assert!(reason(&file(TEXT, &[1, 2, 3, 4, 5, 7])).contains("is damaged: digest 6:22"));
        for (good, bad) in [
            ("code 1\n", "code 2\n"),
            ("assembler ", "assembled "),
            ("80 one 0 1", "sm_80 one 0 1"),
            ("80 one 0 1", "80 one 0"),
            ("80 one 0 1", "80 one 0 1 1"),
            ("80 one 0 1", "80 one -1 1"),
        ] {
            assert!(!reason(&file(&TEXT.replacen(good, bad, 1), &CODE)).is_empty(), "{bad}");
        }
        assert!(reason(&whole[1..]).contains("first line"));
    }
}
