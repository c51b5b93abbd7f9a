//! The committed PTX: is it made from these sources, does it compute what the CPU computes, does it keep quiet
//! about the machine that made it? Each judge is shown to condemn a text with a fault planted in it.

use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn committed() -> String {
    let path = format!("{ROOT}/kernels/nearmiss.ptx");
    std::fs::read_to_string(path).expect("kernels/nearmiss.ptx is committed")
}

fn stamp_of_the_sources() -> String {
    let script = format!("{ROOT}/kernels/ptx.sh");
    let done = Command::new(script).arg("stamp").output().expect("kernels/ptx.sh runs");
    String::from_utf8(done.stdout).expect("the stamp is text").trim().to_owned()
}

fn carries(ptx: &str, stamp: &str) -> bool {
    stamp.len() == 16
        && ptx.lines().next().is_some_and(|first| {
            first.starts_with("// nearmiss kernels, ")
                && first.contains(&format!(" sources {stamp}, rustc 1."))
        })
}

/// The stamp that the module exports, from `.b8 NEARMISS_STAMP[8] = {239, 205, …}`, lowest byte first.
fn exported_stamp(ptx: &str) -> Option<String> {
    let line = ptx.lines().find(|l| l.contains(".visible .global") && l.contains(" NEARMISS_STAMP[8]"))?;
    let bytes = line.split_once('{')?.1.split_once('}')?.0;
    let bytes: Vec<u8> = bytes.split(',').map(|b| b.trim().parse().ok()).collect::<Option<_>>()?;
    Some(format!("{:016x}", u64::from_le_bytes(bytes.try_into().ok()?)))
}

/// Files that the line information names by an absolute path: those of somebody's machine.
fn foreign_paths(ptx: &str) -> Vec<&str> {
    let absolute = |path: &str| path.starts_with('/') || path.get(1..2) == Some(":");
    let named = |line: &&str| line.trim_start().starts_with(".file");
    ptx.lines().filter(named).filter(|l| l.split('"').nth(1).is_none_or(absolute)).collect()
}

/// Functions that may contract a product and a sum: they call fma by name, and the CPU does the same there.
const FMA_BY_NAME: [&str; 0] = [];

/// Instructions whose result another machine would not give to the bit.
fn inexact(ptx: &str) -> Vec<String> {
    let mut function = "";
    let mut found = Vec::new();
    for line in ptx.lines() {
        if line.starts_with('.') && (line.contains(".entry ") || line.contains(".func ")) {
            function = line.rsplit([' ', ')']).find(|w| !w.is_empty()).unwrap_or("").trim_end_matches('(');
        }
        let fault = |word: &str| {
            let contracted = word.starts_with("fma.") && !FMA_BY_NAME.contains(&function);
            let floating_mad = word.starts_with("mad.") && (word.contains(".f32") || word.contains(".f64"));
            contracted || floating_mad || [".approx", ".full", ".ftz"].iter().any(|m| word.contains(m))
        };
        // One line of inline assembly may hold several instructions.
        if line.split_whitespace().any(fault) {
            found.push(format!("{function}: {}", line.trim()));
        }
    }
    found
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "kernels/ptx.sh wants GNU tools")]
fn the_committed_ptx_is_made_from_these_sources() {
    let stamp = stamp_of_the_sources();
    let ptx = committed();
    assert!(carries(&ptx, &stamp), "sources {stamp}; run: kernels/ptx.sh build kernels/nearmiss.ptx");
    assert_eq!(exported_stamp(&ptx).as_deref(), Some(stamp.as_str()), "the exported stamp");
}

#[test]
fn the_committed_ptx_names_no_machine() {
    assert_eq!(foreign_paths(&committed()), Vec::<&str>::new());
}

#[test]
fn the_committed_ptx_rounds_as_the_cpu_does() {
    assert_eq!(inexact(&committed()), Vec::<String>::new());
}

/// build.rs and kernels/ptx.sh compute the stamp each in its own language: they agree.
#[cfg(feature = "cuda")]
#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "kernels/ptx.sh wants GNU tools")]
fn the_build_script_and_the_shell_script_agree_on_the_stamp() {
    assert_eq!(env!("NEARMISS_STAMP"), stamp_of_the_sources());
}

#[test]
fn a_wrong_stamp_is_noticed() {
    let good = "// nearmiss kernels, sources 0123456789abcdef, rustc 1.96.0\n";
    assert!(carries(good, "0123456789abcdef"));
    assert!(!carries(good, "0123456789abcdee"));
    assert!(!carries(good, ""));
    assert!(!carries("//\n", "0123456789abcdef"));
    assert!(!carries(&good.replace("kernels,", "kernels"), "0123456789abcdef"));

    let global = ".visible .global .align 8 .b8 NEARMISS_STAMP[8] = {239, 205, 171, 137, 103, 69, 35, 1};";
    assert_eq!(exported_stamp(global).as_deref(), Some("0123456789abcdef"));
    assert_eq!(exported_stamp(&global.replace("239", "238")).as_deref(), Some("0123456789abcdee"));
    assert_eq!(exported_stamp(&global.replace(".visible ", "")), None);
    assert_eq!(exported_stamp(&global.replace(", 1}", "}")), None);
}

#[test]
fn a_path_of_a_machine_is_noticed() {
    let good = ".file\t1 \"nearmiss/kernels/src/lib.rs\"\n.file\t2 \"rust/library/core/src/option.rs\"\n";
    assert_eq!(foreign_paths(good), Vec::<&str>::new());
    for path in ["/home/me/lib.rs", "/build/lib.rs", "C:\\me\\lib.rs"] {
        assert_eq!(foreign_paths(&good.replace("nearmiss/kernels/src/lib.rs", path)).len(), 1, "{path}");
    }
    assert_eq!(foreign_paths(".file\t1\n").len(), 1, "a file without a name");
}

#[test]
fn an_inexact_instruction_is_noticed() {
    let body =
        |line: &str| format!(".visible .entry k(\n\t.param .u64 k_param_0\n)\n{{\n\t{line}\n\tret;\n}}\n");
    for fine in
        ["add.rn.f32 \t%r1, %r2, %r3;", "mad.lo.s32 \t%r1, %r2, %r3, %r4;", "div.rn.f64 %rd1, %rd2, %rd3;"]
    {
        assert!(inexact(&body(fine)).is_empty(), "{fine}");
    }
    for fault in [
        "sqrt.approx.f32 \t%r1, %r2;",
        "add.rn.ftz.f32 \t%r1, %r2, %r3;",
        "fma.rn.f32 \t%r1, %r2, %r3, %r4;",
        "@%p1 fma.rn.f64 \t%rd1, %rd2, %rd3, %rd4;",
        "div.full.f32 \t%r1, %r2, %r3;",
        "mad.rn.f32 \t%r1, %r2, %r3, %r4;",
        "{ .reg .f32 t; mov.b32 t, %r1; sqrt.approx.f32 t, t; mov.b32 %r2, t; }",
    ] {
        assert_eq!(inexact(&body(fault)), [format!("k: {fault}")]);
    }
}
