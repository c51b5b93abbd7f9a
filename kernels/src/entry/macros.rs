//! Types of kernels, their PTX entries and the table, from lines of [`super`].

/// The associated constants of a kernel, from the parts of its line.
macro_rules! is_entry {
    ($path:expr, [$args:ty], $lanes:expr, $shared:expr $(, exact = $exact:literal)? $(, registers = $registers:literal)?) => {
        type Args = $args;
        const LANES: u32 = $lanes;
        $(const EXACT: bool = $exact;)?
        const SHARED: u32 = $shared;
        $(const REGISTERS: Option<u32> = Some($registers);)?
        const PLACE: Option<usize> = name::place(Self::NAME);
        #[inline(always)]
        fn run<B: Block>(block: &mut B, args: &$args) {
            const { <$args>::FITS };
            ($path)(block, args)
        }
    };
}

/// From lines of `name: path, [arguments], lanes, shared;` makes the types and their PTX entries.
macro_rules! kernels {
    ($($name:ident: $path:expr, [$args:ty], $lanes:expr, $shared:expr $(, exact = $exact:literal)? $(, registers = $registers:literal)?;)*) => {
        $(
            #[doc = concat!("`", stringify!($name), "`")]
            #[allow(non_camel_case_types, reason = "the type is the entry's name")]
            #[derive(Clone, Copy, Debug)]
            pub struct $name;
            impl Entry for $name {
                const NAME: &'static str = stringify!($name);
                is_entry!($path, [$args], $lanes, $shared $(, exact = $exact)? $(, registers = $registers)?);
            }
        )*
        entries! { $($name, stringify!($name);)* }

        const LINES: [Line; [$(stringify!($name)),*].len()] = [$(line::<$name>()),*];

        fn visit_lines(visitor: &mut impl Visit) {
            $(visitor.kernel::<$name>();)*
        }
    };
}

/// The same for the kernels of volumes. `both` precisions of positions share one; `each` has one a
/// precision (`R`). `groups` are those of each precision for some volumes only. [`crate::volumes`]
/// lists the volumes.
macro_rules! kernels_of_volumes {
    (
        both { $($name:ident: $path:expr, [$args:ty], $lanes:expr, $shared:expr $(, exact = $exact:literal)?;)* }
        each { $($each:ident: $each_path:expr, [$each_args:ty], $each_lanes:expr, $each_shared:expr $(, exact = $each_exact:literal)?;)* }
        groups { $($group:ident: $group_path:expr, [$group_args:ty], $group_lanes:expr, $group_shared:expr;)* }
    ) => {
        $(
            #[doc = concat!("`", stringify!($name), "` of a volume")]
            #[allow(non_camel_case_types, reason = "the type is the entry's name")]
            #[derive(Clone, Copy, Debug)]
            pub struct $name<V>(PhantomData<V>);
            impl<V: Kernels> $name<V> {
                const TEXT: &'static Name = &Name::of(&[stringify!($name), "_", V::NAME]);
            }
            impl<V: Kernels> Entry for $name<V> {
                const NAME: &'static str = Self::TEXT.text();
                is_entry!($path, [$args], $lanes, $shared $(, exact = $exact)?);
            }
        )*
        kernels_of_precisions! {
            $($each: $each_path, [$each_args], $each_lanes, $each_shared $(, exact = $each_exact)?;)*
            $($group: $group_path, [$group_args], $group_lanes, $group_shared;)*
        }

        const fn lines_of<V: Kernels>() -> [Line; OF_A_VOLUME] {
            [$(line::<$name<V>>(),)* $(line::<$each<f32, V>>(), line::<$each<f64, V>>(),)*]
        }
        const OF_A_VOLUME: usize = [$(stringify!($name)),*].len() + 2 * [$(stringify!($each)),*].len();

        const fn lines_of_groups<V: Kernels>() -> [Line; OF_GROUPS] {
            [$(line::<$group<f32, V>>(), line::<$group<f64, V>>(),)*]
        }
        const OF_GROUPS: usize = 2 * [$(stringify!($group)),*].len();

        fn visit_volume<V: Kernels>(visitor: &mut impl Visit) {
            $(visitor.kernel::<$name<V>>();)*
            $(
                visitor.kernel::<$each<f32, V>>();
                visitor.kernel::<$each<f64, V>>();
            )*
        }
        fn visit_groups<V: Kernels>(visitor: &mut impl Visit) {
            $(
                visitor.kernel::<$group<f32, V>>();
                visitor.kernel::<$group<f64, V>>();
            )*
        }

        macro_rules! entries_of {
            ($Volume:ty, $volume:literal) => {
                entries! {
                    $($name<$Volume>, concat!(stringify!($name), "_", $volume);)*
                    $($each<f32, $Volume>, concat!(stringify!($each), "_", $volume, "_f32");)*
                    $($each<f64, $Volume>, concat!(stringify!($each), "_", $volume, "_f64");)*
                }
            };
            (groups $Volume:ty, $volume:literal) => {
                entries! {
                    $($group<f32, $Volume>, concat!(stringify!($group), "_", $volume, "_f32");)*
                    $($group<f64, $Volume>, concat!(stringify!($group), "_", $volume, "_f64");)*
                }
            };
        }
    };
}

/// Types of kernels of a volume and a precision of positions.
macro_rules! kernels_of_precisions {
    ($($name:ident: $path:expr, [$args:ty], $lanes:expr, $shared:expr $(, exact = $exact:literal)?;)*) => { $(
        #[doc = concat!("`", stringify!($name), "` of a volume and a precision of positions")]
        #[allow(non_camel_case_types, reason = "the type is the entry's name")]
        #[derive(Clone, Copy, Debug)]
        pub struct $name<R, V>(PhantomData<(R, V)>);
        impl<R: Real, V: Kernels> $name<R, V> {
            const TEXT: &'static Name = &Name::of(&[stringify!($name), "_", V::NAME, precision::<R>()]);
        }
        impl<R: Real, V: Kernels> Entry for $name<R, V> {
            const NAME: &'static str = Self::TEXT.text();
            is_entry!($path, [$args], $lanes, $shared $(, exact = $exact)?);
        }
    )* };
}

/// From the list of volumes makes their names and PTX entries, and the table of all kernels.
macro_rules! table {
    ($($Volume:ident = $volume:literal [$($groups:ident)?], $about:literal;)*) => {
        $(
            impl Kernels for bv::$Volume {
                const NAME: &'static str = $volume;
            }
            entries_of!(bv::$Volume, $volume);
            $(entries_of!($groups bv::$Volume, $volume);)?
        )*

        /// Every kernel's name and the size of its arguments in bytes.
        pub const TABLE: &[(&str, usize)] = &{
            let mut all = [("", 0); LINES.len() $(+ OF_A_VOLUME $(+ for_groups!($groups OF_GROUPS))?)*];
            let mut end = put(&mut all, 0, &LINES);
            $(
                end = put(&mut all, end, &lines_of::<bv::$Volume>());
                $(for_groups!($groups end = put(&mut all, end, &lines_of_groups::<bv::$Volume>()));)?
            )*
            assert!(end == all.len());
            all
        };

        /// Visits every kernel, in the order of [`TABLE`].
        pub fn visit(visitor: &mut impl Visit) {
            visit_lines(visitor);
            $(
                visit_volume::<bv::$Volume>(visitor);
                $(for_groups!($groups visit_groups::<bv::$Volume>(visitor));)?
            )*
        }
    };
}

/// Its second part, if a volume has groups.
macro_rules! for_groups {
    (groups $($what:tt)*) => { $($what)* };
}
