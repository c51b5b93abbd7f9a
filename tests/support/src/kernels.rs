//! Kernels of tests.

/// Test kernels: a name and a block's code for each; with `$args`, and blocks of `$lanes` lanes and
/// `$shared` bytes of shared memory.
#[macro_export]
macro_rules! kernels {
    ([$args:ty], $lanes:expr, $shared:expr; $($name:ident |$b:ident, $a:ident| $body:block)*) => { $(
        #[allow(non_camel_case_types, reason = "the type is the entry's name")]
        struct $name;
        impl Entry for $name {
            const NAME: &'static str = stringify!($name);
            type Args = $args;
            const LANES: u32 = $lanes;
            const SHARED: u32 = $shared;
            fn run<B: Block>($b: &mut B, $a: &$args) $body
        }
    )* };
}
