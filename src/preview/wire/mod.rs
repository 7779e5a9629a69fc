//! What goes between editor, windows and scripts: messages, the bytes they become, and the sockets that carry them.

pub mod connection;
pub mod frame;
pub mod handshake;
pub mod message;
pub mod socket;
#[cfg(test)]
mod tests;
