//! tyndall-optics
