//! The choices of users: the method, and the options of each method.

use crate::error::Error;
use crate::options::entry::options;
use std::fmt;
use std::str::FromStr;

macro_rules! declare {
    ($($family:ident $(($prefix:literal, $options:path))? {
        $($(#[doc = $summary:literal])* $Method:ident = $spec:ident,)*
    })*) => {
        /// A way to fill a hole.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Method {
            #[default]
            $($(
                $(#[doc = $summary])*
                $Method,
            )*)*
        }

        impl Method {
            /// All methods.
            pub const ALL: [Self; [$($(stringify!($Method)),*),*].len()] = [$($(Self::$Method),*),*];

            /// What the method does, in one line.
            #[must_use]
            pub fn summary(self) -> &'static str {
                match self {
                    $($(Self::$Method => concat!($($summary),*).trim(),)*)*
                }
            }
        }

        options! {
            /// The options of each method. Options that several methods share stand in the group of the first of them.
            pub struct MethodOptions {
            }
            groups {
                $($(
                    #[doc = concat!("Options of the group `", $prefix, "`.")]
                    $prefix $family: $options;
                )?)*
            }
        }
    };
}
for_each_method!(declare);

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Method {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        let mut methods = Self::ALL.into_iter();
        methods.find(|m| m.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name);
            let message = format!(
                "unknown method '{name}'; the methods are {}",
                names.join(", ")
            );
            Error::invalid(message)
        })
    }
}
