//! Scenes of many bodies: their kinds, places, filters and memories, on one device and on several.

mod bodies;
mod crossing;
mod elements;
mod exclusions;
mod fans;
mod geometry;
mod grouped;
mod instances;
mod one_detector;
mod rigid;
mod scene;
mod several;
mod slices;
mod starts_crossing;
mod submit;
mod thick;
mod turning;
