//! Structs that Rust fills and shaders read: what has to be the same on both sides, for the test that it is
//! (`tests/gpu/`).

/// A struct as Rust lays it out.
#[derive(Clone, Copy, Debug)]
pub struct Twin {
    /// Its name in the shaders.
    pub name: &'static str,
    /// Its bytes, with what fills it up at the end.
    pub size: usize,
    /// Its fields, with where they begin.
    pub fields: &'static [(&'static str, usize)],
}

/// The twin of a struct in shaders: `twin!(Rust as "WGSL": fields)`, all but those that only fill holes.
macro_rules! twin {
    ($type:ident as $name:literal: $($field:ident),*) => {
        $crate::layers::parts::twin::Twin {
            name: $name,
            size: size_of::<$type>(),
            fields: &[$((stringify!($field), std::mem::offset_of!($type, $field))),*],
        }
    };
    ($type:ident: $($field:ident),*) => {
        $crate::layers::parts::twin::Twin {
            name: stringify!($type),
            size: size_of::<$type>(),
            fields: &[$((stringify!($field), std::mem::offset_of!($type, $field))),*],
        }
    };
}
pub(crate) use twin;
