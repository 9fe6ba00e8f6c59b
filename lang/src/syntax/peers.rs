//! Scenes in the languages of other renderers.

/// What is said of a scene in XML, as Mitsuba reads it.
pub(super) const XML: &str = "this looks like XML, as Mitsuba's scenes are written";

/// How a scene is written here.
pub(super) const BEGINS: &str =
    "a scene begins with `scene 1` and says `shape sphere { radius = 1 m }`";

/// Elements of Mitsuba's scenes that others stand in.
const ELEMENTS: [&str; 14] = [
    "bsdf",
    "default",
    "emitter",
    "film",
    "include",
    "integrator",
    "medium",
    "ref",
    "sampler",
    "scene",
    "sensor",
    "shape",
    "texture",
    "transform",
];

/// Whether such an element, a remark or a declaration of XML begins at a byte.
pub(super) fn is_xml(text: &str, at: usize) -> bool {
    let Some(rest) = text[at..].strip_prefix('<') else { return false };
    let name = rest.trim_start_matches('/');
    let end = name.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(name.len());
    rest.starts_with("?xml") || rest.starts_with("!--") || ELEMENTS.contains(&&name[..end])
}

/// Whether a word is a directive of pbrt's language.
pub(super) fn is_pbrt(word: &str) -> bool {
    const WORDS: [&str; 38] = [
        "Accelerator",
        "ActiveTransform",
        "AreaLightSource",
        "Attribute",
        "AttributeBegin",
        "AttributeEnd",
        "Camera",
        "ColorSpace",
        "ConcatTransform",
        "CoordinateSystem",
        "CoordSysTransform",
        "Film",
        "Identity",
        "Include",
        "Integrator",
        "LightSource",
        "LookAt",
        "MakeNamedMaterial",
        "MakeNamedMedium",
        "Material",
        "MediumInterface",
        "NamedMaterial",
        "ObjectBegin",
        "ObjectEnd",
        "ObjectInstance",
        "PixelFilter",
        "ReverseOrientation",
        "Rotate",
        "Sampler",
        "Scale",
        "Shape",
        "Texture",
        "Transform",
        "TransformBegin",
        "TransformEnd",
        "Translate",
        "WorldBegin",
        "WorldEnd",
    ];
    WORDS.contains(&word)
}
