//! Serial protocol.

mod line;
mod position;
mod reply;
mod state;

pub use line::LineFault;
pub use position::Position;
pub use reply::{Reading, Temperatures};
pub use state::{CommandError, Input, PauseReason, State, StopReason, TABLE};
