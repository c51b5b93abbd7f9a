//! Choices that have names. One list gives an enum its variants, with documentation, names and
//! descriptions.

/// A choice with a name, as on a command line, in a file or in a report.
pub trait Named: Copy + Eq + Send + Sync + 'static {
    /// Every choice.
    const ALL: &'static [Self];
    /// Returns its name.
    fn name(self) -> &'static str;
    /// Returns its description, from its documentation.
    fn about(self) -> &'static str;
    /// Returns the choice of a name, if there is one.
    fn of(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|choice| choice.name() == name)
    }
}

macro_rules! named {
    ($(#[$meta:meta])* pub enum $choice:ident { $($(#[doc = $about:literal])+ $variant:ident = $name:literal,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum $choice {
            $($(#[doc = $about])+ $variant,)+
        }

        impl $choice {
            /// Every choice.
            pub const ALL: [$choice; [$($name),+].len()] = [$($choice::$variant),+];

            /// Returns its name, as on the command line and in reports.
            pub const fn name(self) -> &'static str {
                match self {
                    $($choice::$variant => $name,)+
                }
            }
        }

        impl $crate::query::Named for $choice {
            const ALL: &'static [Self] = &$choice::ALL;

            fn name(self) -> &'static str {
                $choice::name(self)
            }

            fn about(self) -> &'static str {
                match self {
                    $($choice::$variant => concat!($($about),+).trim_ascii(),)+
                }
            }
        }

        impl std::fmt::Display for $choice {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        #[cfg(feature = "serde")]
        impl serde::Serialize for $choice {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }
    };
}

pub(crate) use named;
