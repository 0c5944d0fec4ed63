//! What is rendered: everything resolved, built and placed. After this nobody sees text, names of variables
//! or files.

pub mod camera;
pub mod clear;
mod environment;
pub mod light;
pub mod material;
pub mod settings;
mod world;

pub use camera::Camera;
pub use clear::{Clear, Filling, Meeting};
pub use environment::Environment;
pub use light::Light;
pub use material::Material;
pub use settings::Settings;
pub use world::{Hit, Owners, Surface, World};

/// A prepared picture.
#[derive(Debug)]
pub struct Shot {
    /// What rays meet.
    pub world: World,
    /// What is seen through before it, if there is something.
    pub ghosts: Option<World>,
    /// The chosen camera.
    pub camera: Camera,
    /// The lights.
    pub lights: Vec<Light>,
    /// Materials by the id that [`Surface::material`] carries.
    pub materials: Vec<Material>,
    /// Size, samples and what else the picture is a function of.
    pub settings: Settings,
}
