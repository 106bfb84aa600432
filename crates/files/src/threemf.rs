//! 3MF: meshes, units, transforms, components, build items, and parts in several files.
//!
//! Source: 3MF Consortium, "3MF Core Specification" 1.3 and "3MF Production Extension" 1.1. Colours,
//! materials and slices are passed over; an extension that a file declares as required is refused
//! unless it is known here.

use std::collections::BTreeMap;
use std::io::BufRead;
use std::str::FromStr;

use quick_xml::Reader;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};

use crate::Part;
use crate::archive::Archive;
use crate::error::FileError;
use crate::limits::{COMPONENT_DEPTH, COMPONENTS, REACH_MM, TRIANGLES, VERTICES, XML_DEPTH};

/// Extensions that may be required: the core itself, production, and looks.
const KNOWN_EXTENSIONS: [&str; 4] = [
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
];

/// Relationship that leads to the model.
const MODEL_RELATION: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/// Where the model lies when no relationship says so.
const USUAL_MODEL: &str = "3D/3dmodel.model";

pub(crate) fn read(bytes: &[u8]) -> Result<Vec<Part>, FileError> {
    let mut archive = Archive::open(bytes)?;
    let root = root_model(&mut archive)?;
    let mut models = BTreeMap::new();
    load(&mut archive, &root, &mut models)?;
    let items = models[&root].items.clone();
    if items.len() > COMPONENTS {
        return Err(FileError::TooMuch { what: "build items", limit: COMPONENTS });
    }
    let mut plan = Assembly { archive, models, followed: 0, triangles: 0, vertices: 0 };
    let mut parts = Vec::new();
    for item in &items {
        let mut part = Part::default();
        plan.add(&root, item, &IDENTITY, 0, &mut part)?;
        if !part.triangles.is_empty() {
            parts.push(part);
        }
    }
    Ok(parts)
}

/// Rows of an affine map: a point times the first three, plus the last, mm.
type Transform = [[f64; 3]; 4];

const IDENTITY: Transform = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];

/// `first`, then `second`.
fn chained(first: &Transform, second: &Transform) -> Transform {
    let mut out = [[0.0; 3]; 4];
    for (i, row) in out.iter_mut().enumerate() {
        for (j, x) in row.iter_mut().enumerate() {
            *x = (0..3).map(|k| first[i][k] * second[k][j]).sum();
        }
    }
    for j in 0..3 {
        out[3][j] += second[3][j];
    }
    out
}

fn moved(p: [f64; 3], t: &Transform) -> [f64; 3] {
    [0, 1, 2].map(|j| p[0] * t[0][j] + p[1] * t[1][j] + p[2] * t[2][j] + t[3][j])
}

/// Whether the map turns things inside out.
fn mirrors(t: &Transform) -> bool {
    let [a, b, c, _] = t;
    let det = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0]);
    det < 0.0
}

/// One file of the archive that holds objects.
#[derive(Default)]
struct Model {
    /// mm in one of its units.
    unit: f64,
    objects: BTreeMap<u32, Object>,
    items: Vec<Reference>,
}

#[derive(Default, Clone)]
struct Object {
    name: String,
    /// Whether it is to be printed: supports and aids of other programs are not.
    printed: bool,
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    components: Vec<Reference>,
}

/// A component or a build item: which object, and how it is moved.
#[derive(Clone)]
struct Reference {
    object: u32,
    /// File of the object, if it is another one.
    path: Option<String>,
    transform: Transform,
}

/// Follows references and puts parts together.
struct Assembly<'a> {
    archive: Archive<'a>,
    models: BTreeMap<String, Model>,
    followed: usize,
    triangles: usize,
    vertices: usize,
}

impl Assembly<'_> {
    fn add(
        &mut self,
        from: &str,
        reference: &Reference,
        outer: &Transform,
        depth: usize,
        part: &mut Part,
    ) -> Result<(), FileError> {
        self.followed += 1;
        if self.followed > COMPONENTS {
            return Err(FileError::TooMuch { what: "components", limit: COMPONENTS });
        }
        if depth > COMPONENT_DEPTH {
            return Err(FileError::TooMuch { what: "components within each other", limit: COMPONENT_DEPTH });
        }
        let path = match &reference.path {
            None => from.to_owned(),
            Some(path) => self.archive.find(path).ok_or_else(|| {
                malformed(from, format!("names the file {path}, which is not in the archive"))
            })?,
        };
        load(&mut self.archive, &path, &mut self.models)?;
        let model = &self.models[&path];
        let object = model.objects.get(&reference.object).ok_or_else(|| {
            malformed(from, format!("names object {}, which is not there", reference.object))
        })?;
        // Lengths of a transform are in the unit of the file that states it.
        let stated = self.models[from].unit;
        let unit = model.unit;
        let mut transform = reference.transform;
        transform[3] = transform[3].map(|x| x * stated);
        let transform = chained(&transform, outer);
        if !object.printed {
            return Ok(());
        }
        if part.name.is_empty() {
            part.name.clone_from(&object.name);
        }
        self.triangles += object.triangles.len();
        self.vertices += object.vertices.len();
        if self.triangles > TRIANGLES || self.vertices > VERTICES {
            return Err(FileError::TooMuch { what: "triangles", limit: TRIANGLES });
        }
        append(part, object, unit, &transform).map_err(|cause| malformed(&path, cause))?;
        let components = object.components.clone();
        for component in &components {
            self.add(&path, component, &transform, depth + 1, part)?;
        }
        Ok(())
    }
}

/// Adds an object's own mesh to a part.
fn append(part: &mut Part, object: &Object, unit: f64, transform: &Transform) -> Result<(), String> {
    let first = part.vertices.len() as u32;
    for &vertex in &object.vertices {
        let p = moved(vertex.map(|x| x * unit), transform);
        if !p.iter().all(|x| x.abs() <= REACH_MM) {
            return Err(format!("a vertex lies more than {REACH_MM} mm from the origin"));
        }
        part.vertices.push(p.map(|x| x as f32));
    }
    let mirrored = mirrors(transform);
    let turned = |[a, b, c]: [u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
    part.triangles.extend(object.triangles.iter().map(|t| turned(t.map(|v| v + first))));
    Ok(())
}

fn malformed(place: &str, cause: impl Into<String>) -> FileError {
    FileError::Malformed { place: place.to_owned(), cause: cause.into() }
}

/// The file of the archive that the relationships call the model.
fn root_model(archive: &mut Archive<'_>) -> Result<String, FileError> {
    let mut target = None;
    if let Some(rels) = archive.find("_rels/.rels") {
        elements(archive, &rels, |element, _| {
            let Element::Open(start) = element else { return Ok(()) };
            if start.local_name().as_ref() == "Relationship" {
                let words = attributes(start)?;
                if words.iter().any(|(k, v)| k == "Type" && v == MODEL_RELATION) && target.is_none() {
                    target = words.into_iter().find(|(k, _)| k == "Target").map(|(_, v)| v);
                }
            }
            Ok(())
        })?;
    }
    let named = target.as_deref().and_then(|t| archive.find(t));
    named.or_else(|| archive.find(USUAL_MODEL)).ok_or(FileError::NotThreeMf)
}

/// Reads a file of objects, once.
fn load(
    archive: &mut Archive<'_>,
    path: &str,
    models: &mut BTreeMap<String, Model>,
) -> Result<(), FileError> {
    if models.contains_key(path) {
        return Ok(());
    }
    let held = |m: &Model| m.objects.values().map(|o| o.vertices.len()).sum::<usize>();
    let mut parser = Parser { vertices: models.values().map(held).sum(), ..Parser::default() };
    elements(archive, path, |element, depth| match element {
        Element::Open(start) => parser.open(start, depth),
        Element::Close(name) => parser.close(name),
    })?;
    if parser.model.unit == 0.0 {
        return Err(malformed(path, "has no <model>"));
    }
    models.insert(path.to_owned(), parser.model);
    Ok(())
}

enum Element<'e, 's> {
    Open(&'e BytesStart<'s>),
    Close(&'e str),
}

/// Hands all elements of an XML file to `take`, an empty one as opened and closed.
fn elements(
    archive: &mut Archive<'_>,
    path: &str,
    mut take: impl FnMut(Element<'_, '_>, usize) -> Result<(), String>,
) -> Result<(), FileError> {
    archive.read(path, |bytes| {
        if bytes.fill_buf().is_ok_and(|b| b.starts_with(&[0xff, 0xfe]) || b.starts_with(&[0xfe, 0xff])) {
            return Err(FileError::Encoding { seems: "UTF-16" });
        }
        let mut reader = Reader::from_reader(bytes);
        let (mut buffer, mut depth) = (Vec::new(), 0_usize);
        loop {
            let event = reader.read_event_into(&mut buffer);
            let at = reader.buffer_position();
            let fault = |cause: String| malformed(path, format!("byte {at}: {cause}"));
            match event {
                Ok(Event::Start(start)) => {
                    depth += 1;
                    if depth > XML_DEPTH {
                        return Err(FileError::TooMuch {
                            what: "XML elements within each other",
                            limit: XML_DEPTH,
                        });
                    }
                    take(Element::Open(&start), depth).map_err(fault)?;
                }
                Ok(Event::Empty(start)) => {
                    take(Element::Open(&start), depth + 1).map_err(fault)?;
                    take(Element::Close(start.local_name().as_ref()), depth + 1).map_err(fault)?;
                }
                Ok(Event::End(end)) => {
                    take(Element::Close(end.local_name().as_ref()), depth).map_err(fault)?;
                    depth = depth.saturating_sub(1);
                }
                Ok(Event::Eof) if depth > 0 => {
                    return Err(FileError::Xml {
                        part: path.to_owned(),
                        cause: "it ends too early".to_owned(),
                    });
                }
                Ok(Event::Eof) => return Ok(()),
                Ok(_) => {}
                Err(error) => {
                    return Err(FileError::Xml {
                        part: path.to_owned(),
                        cause: format!("byte {at}: {error}"),
                    });
                }
            }
            buffer.clear();
        }
    })
}

/// Attributes by their whole names, entities resolved.
fn attributes(start: &BytesStart<'_>) -> Result<Vec<(String, String)>, String> {
    let mut found = Vec::new();
    for attribute in start.attributes() {
        let attribute = attribute.map_err(|e| e.to_string())?;
        let value = attribute.normalized_value(XmlVersion::Explicit1_0).map_err(|e| e.to_string())?;
        found.push((attribute.key.as_ref().to_owned(), value.into_owned()));
    }
    Ok(found)
}

/// Builds a model from its elements.
#[derive(Default)]
struct Parser {
    model: Model,
    /// Number of the object that is open, and the object.
    open: Option<(u32, Object)>,
    /// Corners read so far, in all files.
    vertices: usize,
}

impl Parser {
    fn open(&mut self, start: &BytesStart<'_>, depth: usize) -> Result<(), String> {
        match (start.local_name().as_ref(), &mut self.open) {
            ("model", None) if depth == 1 => self.model(start),
            ("object", None) => {
                let words = attributes(start)?;
                let printed =
                    matches!(local(&words, "type"), None | Some("model" | "solidsupport" | "surface"));
                let id = whole(&words, "id")?;
                let name = local(&words, "name").unwrap_or_default().chars().take(200).collect();
                self.open = Some((id, Object { name, printed, ..Object::default() }));
                Ok(())
            }
            ("vertex", Some((_, object))) => {
                self.vertices += 1;
                if self.vertices > VERTICES {
                    return Err(format!("more than {VERTICES} vertices"));
                }
                object.vertices.push(vertex(start)?);
                Ok(())
            }
            ("triangle", Some((_, object))) => {
                let corners = triangle(start)?;
                if corners.iter().any(|&v| v as usize >= object.vertices.len()) {
                    return Err("a triangle names a vertex that is not there".to_owned());
                }
                if object.triangles.len() >= TRIANGLES {
                    return Err(format!("more than {TRIANGLES} triangles"));
                }
                object.triangles.push(corners);
                Ok(())
            }
            ("component", Some((_, object))) => {
                object.components.push(reference(start)?);
                if object.components.len() > COMPONENTS {
                    return Err(format!("more than {COMPONENTS} components"));
                }
                Ok(())
            }
            ("item", None) => {
                let words = attributes(start)?;
                // PrusaSlicer and its kin mark what stands beside the bed.
                if local(&words, "printable") != Some("0") {
                    self.model.items.push(reference(start)?);
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn close(&mut self, name: &str) -> Result<(), String> {
        if name != "object" {
            return Ok(());
        }
        if let Some((id, object)) = self.open.take()
            && self.model.objects.insert(id, object).is_some()
        {
            return Err(format!("there are two objects {id}"));
        }
        Ok(())
    }

    fn model(&mut self, start: &BytesStart<'_>) -> Result<(), String> {
        let words = attributes(start)?;
        self.model.unit = match local(&words, "unit").unwrap_or("millimeter") {
            "micron" => 0.001,
            "millimeter" => 1.0,
            "centimeter" => 10.0,
            "inch" => 25.4,
            "foot" => 304.8,
            "meter" => 1000.0,
            other => return Err(format!("unknown unit \"{other}\"")),
        };
        for prefix in local(&words, "requiredextensions").unwrap_or_default().split_whitespace() {
            let name =
                words.iter().find(|(k, _)| k.strip_prefix("xmlns:") == Some(prefix)).map(|(_, v)| v.as_str());
            let name = name.unwrap_or(prefix);
            if !KNOWN_EXTENSIONS.contains(&name) {
                return Err(format!("needs the 3MF extension {name}, which is not supported"));
            }
        }
        Ok(())
    }
}

/// The attribute of this name, with or without a prefix.
fn local<'w>(words: &'w [(String, String)], name: &str) -> Option<&'w str> {
    let is_it = |key: &str| key == name || key.rsplit_once(':').is_some_and(|(_, k)| k == name);
    words.iter().find(|(key, _)| is_it(key)).map(|(_, value)| value.as_str())
}

fn whole(words: &[(String, String)], name: &str) -> Result<u32, String> {
    let text = local(words, name).ok_or_else(|| format!("\"{name}\" is missing"))?;
    text.trim().parse().map_err(|_| format!("{name}=\"{text}\" is no number"))
}

/// The numbers of three attributes. Corners and triangles come by the million: they are read without copies.
fn three<T: FromStr + Copy>(start: &BytesStart<'_>, names: [&str; 3]) -> Result<[Option<T>; 3], String> {
    let mut found = [None; 3];
    for attribute in start.attributes().with_checks(false) {
        let attribute = attribute.map_err(|e| e.to_string())?;
        if let Some(place) = names.iter().position(|name| *name == attribute.key.as_ref()) {
            let value = attribute.value.trim().parse();
            found[place] = Some(value.map_err(|_| format!("\"{}\" is no number", attribute.value))?);
        }
    }
    Ok(found)
}

fn vertex(start: &BytesStart<'_>) -> Result<[f64; 3], String> {
    let found = three(start, ["x", "y", "z"])?.map(|x| x.unwrap_or(f64::NAN));
    if found.iter().all(|x| x.is_finite()) { Ok(found) } else { Err("a vertex needs x, y and z".to_owned()) }
}

fn triangle(start: &BytesStart<'_>) -> Result<[u32; 3], String> {
    match three(start, ["v1", "v2", "v3"])? {
        [Some(a), Some(b), Some(c)] => Ok([a, b, c]),
        _ => Err("a triangle needs v1, v2 and v3".to_owned()),
    }
}

fn reference(start: &BytesStart<'_>) -> Result<Reference, String> {
    let words = attributes(start)?;
    let transform = match local(&words, "transform") {
        None => IDENTITY,
        Some(text) => {
            let numbers: Vec<f64> = text
                .split_whitespace()
                .map_while(|w| w.parse().ok())
                .filter(|x: &f64| x.is_finite())
                .collect();
            if numbers.len() != 12 || text.split_whitespace().count() != 12 {
                return Err(format!("transform=\"{text}\" is not twelve numbers"));
            }
            let row = |i: usize| [numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]];
            [row(0), row(1), row(2), row(3)]
        }
    };
    Ok(Reference {
        object: whole(&words, "objectid")?,
        path: local(&words, "path").map(str::to_owned),
        transform,
    })
}
