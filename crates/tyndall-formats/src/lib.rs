//! tyndall-formats
