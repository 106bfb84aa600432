//! What holds up overhangs: thin crossing plates [Zhao], and full support volumes to compare with
//! and to choose an orientation by.
//!
//! [Zhao]: B. Zhao, S. Wang, F. Xie, "Research on Automatic Generation Algorithm for the Supporting
//! Structure in FDM Process".

pub mod plane;
pub mod points;
pub mod volumes;
