//! Options that can be set by name. One declaration makes the field, its default, its setter, its range check, its help
//! and its text form.
//!
//! ```text
//! options! {
//!     /// How patches are refined.
//!     pub struct RefinementOptions {
//!         /// Target edge length of new triangles over that of the rim
//!         density: f64 = 1.0, in 0.1..=100.0;
//!     }
//! }
//! ```
//!
//! gives the public field `density`, the setter `RefinementOptions::density(self, f64)`, and an [`Entry`] with the name
//! `density`. A struct that holds this one as a group `refine` has the entry `refine.density`.

use crate::error::{Error, Result};
use std::fmt;
use std::ops::RangeInclusive;

/// The type of an option, with functions to read, write and check a value.
pub(crate) trait Value: Sized + Clone + 'static {
    /// The restrictions on values besides their type.
    type Limits: 'static;

    /// Reads a value; `None` when the text is no value or the value is not within the limits.
    fn read(text: &str, limits: &Self::Limits) -> Option<Self>;

    /// Writes a value as a text for [`read`](Self::read).
    fn write(&self, limits: &Self::Limits) -> String;

    /// Whether the value is within the limits.
    fn is_within(&self, limits: &Self::Limits) -> bool;

    /// The allowed values in words.
    fn allowed(limits: &Self::Limits) -> String;
}

macro_rules! number {
    ($kind:literal: $($type:ty),*) => {$(
        impl Value for $type {
            type Limits = RangeInclusive<$type>;

            fn read(text: &str, limits: &Self::Limits) -> Option<Self> {
                text.parse().ok().filter(|value: &Self| value.is_within(limits))
            }

            fn write(&self, _: &Self::Limits) -> String {
                self.to_string()
            }

            fn is_within(&self, limits: &Self::Limits) -> bool {
                limits.contains(self)
            }

            fn allowed(limits: &Self::Limits) -> String {
                format!(concat!($kind, " from {} to {}"), limits.start(), limits.end())
            }
        }
    )*};
}

number!("a number": f64);
number!("an integer": u32, usize);

/// A switch.
impl Value for bool {
    type Limits = ();

    fn read(text: &str, (): &()) -> Option<Self> {
        match text {
            "on" | "true" | "1" => Some(true),
            "off" | "false" | "0" => Some(false),
            _ => None,
        }
    }

    fn write(&self, (): &()) -> String {
        if *self { "on" } else { "off" }.to_owned()
    }

    fn is_within(&self, (): &()) -> bool {
        true
    }

    fn allowed((): &()) -> String {
        "on or off".to_owned()
    }
}

/// A value, or a word that stands for `None`.
impl<T: Value> Value for Option<T> {
    /// The word, and the limits of the value.
    type Limits = (&'static str, T::Limits);

    fn read(text: &str, (none, limits): &Self::Limits) -> Option<Self> {
        if text == *none {
            return Some(None);
        }
        T::read(text, limits).map(Some)
    }

    fn write(&self, (none, limits): &Self::Limits) -> String {
        self.as_ref()
            .map_or_else(|| (*none).to_owned(), |value| value.write(limits))
    }

    fn is_within(&self, (_, limits): &Self::Limits) -> bool {
        self.as_ref().is_none_or(|value| value.is_within(limits))
    }

    fn allowed((none, limits): &Self::Limits) -> String {
        format!("{none}, or {}", T::allowed(limits))
    }
}

/// A type with a few values that have names.
pub(crate) trait Choice: Copy + PartialEq + 'static {
    /// The values, in the order in which they are listed.
    fn all() -> Vec<Self>;

    /// The name of a value.
    fn name(self) -> &'static str;
}

impl<T: Choice> Value for T {
    type Limits = ();

    fn read(text: &str, (): &()) -> Option<Self> {
        Self::all().into_iter().find(|value| value.name() == text)
    }

    fn write(&self, (): &()) -> String {
        self.name().to_owned()
    }

    fn is_within(&self, (): &()) -> bool {
        true
    }

    fn allowed((): &()) -> String {
        let names: Vec<&str> = Self::all().into_iter().map(Self::name).collect();
        match names.split_last() {
            Some((last, [])) => (*last).to_owned(),
            Some((last, others)) => format!("{} or {last}", others.join(", ")),
            None => String::new(),
        }
    }
}

/// Sets an option from a text. Returns false when the text is not allowed.
type Setter<O> = dyn Fn(&mut O, &str) -> bool + Send + Sync;

/// An option of the options `O` that can be set by its name.
pub struct Entry<O> {
    name: String,
    help: &'static str,
    allowed: String,
    read: Box<Setter<O>>,
    write: Box<dyn Fn(&O) -> String + Send + Sync>,
    is_within: Box<dyn Fn(&O) -> bool + Send + Sync>,
}

impl<O> Entry<O> {
    /// The name, such as `refine.density`.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The help text: what the option does, with its unit, in one line.
    #[must_use]
    pub fn help(&self) -> &'static str {
        self.help
    }

    /// The allowed values, in words.
    #[must_use]
    pub fn allowed(&self) -> &str {
        &self.allowed
    }

    /// The present value in `options`, as a text for [`set`](Self::set).
    #[must_use]
    pub fn value(&self, options: &O) -> String {
        (self.write)(options)
    }

    /// Sets the option.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] for a value that is not allowed. The options are then unchanged.
    pub fn set(&self, options: &mut O, value: &str) -> Result<()> {
        if (self.read)(options, value) {
            Ok(())
        } else {
            Err(self.refusal(value))
        }
    }

    /// Checks that the present value in `options` is allowed.
    pub(crate) fn check(&self, options: &O) -> Result<()> {
        if (self.is_within)(options) {
            Ok(())
        } else {
            Err(self.refusal(&self.value(options)))
        }
    }

    /// Puts an entry that belongs to no group into one.
    pub(super) fn put_into_group(&mut self, group: &str) {
        if !self.name.contains('.') {
            self.name = format!("{group}.{}", self.name);
        }
    }

    fn refusal(&self, value: &str) -> Error {
        Error::invalid(format!(
            "{} cannot be '{value}': it takes {}",
            self.name, self.allowed
        ))
    }
}

impl<O: 'static> Entry<O> {
    /// The entry of a field. Its name is `field` with hyphens.
    pub(crate) fn of_field<T: Value>(
        field: &str,
        help: &'static str,
        limits: fn() -> T::Limits,
        get: fn(&O) -> &T,
        get_mut: fn(&mut O) -> &mut T,
    ) -> Self {
        Self {
            name: field.replace('_', "-"),
            help: help.trim(),
            allowed: T::allowed(&limits()),
            read: Box::new(move |options, text| match T::read(text, &limits()) {
                Some(value) => {
                    *get_mut(options) = value;
                    true
                }
                None => false,
            }),
            write: Box::new(move |options| get(options).write(&limits())),
            is_within: Box::new(move |options| get(options).is_within(&limits())),
        }
    }

    /// The same entry for options `P` that contain these options as the group `group`. An empty name makes no group.
    pub(crate) fn within<P: 'static>(
        self,
        group: &str,
        get: fn(&P) -> &O,
        get_mut: fn(&mut P) -> &mut O,
    ) -> Entry<P> {
        let Self {
            read,
            write,
            is_within,
            ..
        } = self;
        Entry {
            name: match group {
                "" => self.name,
                _ => format!("{group}.{}", self.name),
            },
            help: self.help,
            allowed: self.allowed,
            read: Box::new(move |options, text| read(get_mut(options), text)),
            write: Box::new(move |options| write(get(options))),
            is_within: Box::new(move |options| is_within(get(options))),
        }
    }
}

impl<O> fmt::Debug for Entry<O> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Entry").field("name", &self.name).finish()
    }
}

/// Options with entries.
pub(crate) trait Options: Sized + 'static {
    /// The entries, in the order of their declaration.
    fn entries() -> Vec<Entry<Self>>;
}

/// Declares a struct of options; see the head of this file.
///
/// A field with `in` and limits has an entry. Its help is the first line of the field's documentation. `groups` after
/// the struct lists structs of options with the prefix of their entries' names; an empty prefix adds nothing.
macro_rules! options {
    (
        $(#[$about:meta])*
        pub struct $Name:ident {
            $(
                #[doc = $help:literal]
                $(#[doc = $more:literal])*
                $field:ident: $type:ty = $default:expr $(, in $limits:expr)?;
            )*
        }
        $(groups {
            $(
                $(#[$group_about:meta])*
                $prefix:literal $group:ident: $group_type:ty;
            )*
        })?
    ) => {
        $(#[$about])*
        #[derive(Clone, Debug, PartialEq)]
        #[non_exhaustive]
        pub struct $Name {
            $(
                #[doc = $help]
                $(#[doc = $more])*
                #[doc = ""]
                #[doc = concat!("Default: `", stringify!($default), "`.", $(" Range: `", stringify!($limits), "`.")?)]
                pub $field: $type,
            )*
            $($(
                $(#[$group_about])*
                pub $group: $group_type,
            )*)?
        }

        impl Default for $Name {
            fn default() -> Self {
                Self {
                    $($field: $default,)*
                    $($($group: Default::default(),)*)?
                }
            }
        }

        impl $Name {
            $(
                #[doc = concat!("The same with another [`", stringify!($field), "`](Self#structfield.", stringify!($field), ").")]
                #[must_use]
                pub fn $field(mut self, $field: $type) -> Self {
                    self.$field = $field;
                    self
                }
            )*
            $($(
                #[doc = concat!("The same with other [`", stringify!($group), "`](Self#structfield.", stringify!($group), ") options.")]
                #[must_use]
                pub fn $group(mut self, $group: $group_type) -> Self {
                    self.$group = $group;
                    self
                }
            )*)?
        }

        impl $crate::options::entry::Options for $Name {
            fn entries() -> Vec<$crate::options::entry::Entry<Self>> {
                let own: Vec<$crate::options::entry::Entry<Self>> = vec![$($(
                    $crate::options::entry::Entry::of_field::<$type>(
                        stringify!($field),
                        $help,
                        || $limits,
                        |options: &Self| &options.$field,
                        |options: &mut Self| &mut options.$field,
                    ),
                )?)*];
                own.into_iter()
                    $($(.chain(
                        <$group_type as $crate::options::entry::Options>::entries()
                            .into_iter()
                            .map(|entry| entry.within(
                                $prefix,
                                |options: &Self| &options.$group,
                                |options: &mut Self| &mut options.$group,
                            ))
                    ))*)?
                    .collect()
            }
        }
    };
}
pub(crate) use options;

/// Makes an enumeration a [`Choice`] by the names of its values.
macro_rules! choice {
    ($Type:ty { $($value:ident = $name:literal),* $(,)? }) => {
        impl $crate::options::entry::Choice for $Type {
            fn all() -> Vec<Self> {
                vec![$(Self::$value),*]
            }

            fn name(self) -> &'static str {
                match self {
                    $(Self::$value => $name,)*
                }
            }
        }
    };
}
pub(crate) use choice;
