//! Pages for people: what they say, and how they are used.

mod browser;
mod compare;
mod figures;
mod jobs;
mod maneuvers;
mod models;
