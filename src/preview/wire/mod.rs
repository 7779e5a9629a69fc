//! What goes between editor, windows and scripts: messages, the bytes they become, and the sockets that carry them.

pub mod link;
pub mod message;
#[cfg(test)]
mod tests;
