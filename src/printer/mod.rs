//! Serial protocol.
