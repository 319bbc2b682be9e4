//! Models as data.
pub mod catalog;
mod document;
mod edit;
pub use document::{
    Constant, Definition, Input, ModelDocument, Output, Parameter, Per, Start, State,
};
pub use edit::{Edit, EditError, EditKind};
