//! Windows of scenes on other machines: the way there, both ends of it, and the files that travel along.

pub mod address;
pub mod attach;
pub mod far;
pub mod fetch;
pub mod ssh;
