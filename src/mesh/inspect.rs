//! From the bytes of a file to a model that is ready to be sliced, and what there is to say of it.

use super::repair::{Condition, MERGE_MM, Repairs, repair};
use super::stl::{Format, Parsed, StlError, StlReader};
use super::{Box3, Mesh};
use serde::Serialize;

/// A model as it goes into slicing, and what was found in its file.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedModel {
    /// Welded and repaired; has at least one triangle.
    pub mesh: Mesh,
    /// What was found and repaired.
    pub inspection: Inspection,
}

/// A remark on a model: something the user should know that does not keep us from slicing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Warning {
    /// One word for programs, such as `open_edges`.
    pub code: &'static str,
    /// One sentence for people.
    pub message: String,
}

/// A box in space, mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Extent {
    /// Smallest x, y and z.
    pub min: [f32; 3],
    /// Largest x, y and z.
    pub max: [f32; 3],
}

/// What a file holds. `triangles`, `solids` and the counts of repairs speak of the file; bounds,
/// volume, area, vertices, shells and the edges left over speak of the mesh once it is repaired.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Inspection {
    /// Binary or text.
    pub format: Format,
    /// Names of a text file's solids; empty for a binary one.
    pub solids: Vec<String>,
    /// Triangles in the file.
    pub triangles: u64,
    /// Triangles left after the repairs.
    pub triangles_kept: usize,
    /// Different corners.
    pub vertices: usize,
    /// The smallest box around the part, mm.
    pub bounds: Extent,
    /// Enclosed volume, mm3. An open surface is closed for this by the cone from its border to the
    /// border's centre; where shells overlap, the common part counts once for each.
    pub volume_mm3: f64,
    /// Area of the surface, mm2.
    pub area_mm2: f64,
    /// Parts that share no edge with each other.
    pub shells: usize,
    /// Edges with one triangle, after the repairs.
    pub open_edges: usize,
    /// Edges with three triangles or more, after the repairs.
    pub non_manifold_edges: usize,
    /// Triangles that looked the wrong way in the file, in shells of which others did not; turned.
    pub flipped_faces: usize,
    /// Triangles without area; dropped.
    pub degenerate_dropped: usize,
    /// Triangles that repeat another one; dropped.
    pub duplicates_dropped: usize,
    /// Shells that looked inward as a whole; turned.
    pub inverted_shells: usize,
    /// Vertices on open edges merged into a near one.
    pub merged_vertices: usize,
    /// Remarks, in the order of the steps that made them.
    pub warnings: Vec<Warning>,
}

/// Reads a whole STL file: parses, welds, repairs and inspects. For a file that comes in pieces
/// push them to an [`StlReader`] and give its result to [`LoadedModel::new`].
///
/// ```
/// let error = foothold::mesh::load(b"").unwrap_err();
/// assert_eq!(error.to_string(), "empty: the file has no bytes");
/// ```
pub fn load(bytes: &[u8]) -> Result<LoadedModel, StlError> {
    let mut reader = StlReader::with_size(bytes.len() as u64);
    reader.push(bytes)?;
    LoadedModel::new(reader.finish()?)
}

impl LoadedModel {
    /// Repairs and inspects what was read. Fails when no triangle has an area.
    pub fn new(parsed: Parsed) -> Result<LoadedModel, StlError> {
        let mut mesh = parsed.mesh;
        let (mut repairs, condition) = repair(&mut mesh);
        repairs.degenerate_dropped += parsed.degenerate as usize;
        let bounds = mesh.bounds().ok_or(StlError::NoTriangles)?;
        let mut inspection = Inspection {
            format: parsed.format,
            solids: parsed.solids,
            triangles: parsed.triangles,
            triangles_kept: mesh.triangles.len(),
            vertices: mesh.vertices.len(),
            bounds: Extent::from(bounds),
            volume_mm3: condition.volume,
            area_mm2: mesh.area(),
            shells: condition.shells,
            open_edges: condition.open_edges,
            non_manifold_edges: condition.non_manifold_edges,
            flipped_faces: repairs.flipped_faces,
            degenerate_dropped: repairs.degenerate_dropped,
            duplicates_dropped: repairs.duplicates_dropped,
            inverted_shells: repairs.inverted_shells,
            merged_vertices: repairs.merged_vertices,
            warnings: Vec::new(),
        };
        let of_file = file_warnings(inspection.triangles, parsed.trailing_bytes, parsed.endsolid_missing);
        let of_mesh =
            [repair_warnings(&repairs), condition_warnings(&condition), volume_warning(&inspection)];
        let of_size = unit_warning(&inspection.bounds);
        inspection.warnings =
            of_file.into_iter().chain(of_mesh.into_iter().flatten()).chain(of_size).collect();
        Ok(LoadedModel { mesh, inspection })
    }
}

impl From<Box3> for Extent {
    fn from(b: Box3) -> Extent {
        Extent { min: b.min.to_array(), max: b.max.to_array() }
    }
}

fn file_warnings(triangles: u64, trailing_bytes: u64, endsolid_missing: bool) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if trailing_bytes > 0 {
        let message = format!(
            "{} after the last of {triangles} triangles were ignored",
            counted(trailing_bytes, "byte")
        );
        warnings.push(Warning { code: "trailing_bytes", message });
    }
    if endsolid_missing {
        let message = "a closing \"endsolid\" is missing: the file may have been cut off".to_owned();
        warnings.push(Warning { code: "endsolid_missing", message });
    }
    warnings
}

/// A remark for each kind of repair that changes the part or hints at a fault of the exporter.
/// Triangles without area are only counted: dropping them changes nothing.
fn repair_warnings(repairs: &Repairs) -> Vec<Warning> {
    let Repairs {
        duplicates_dropped,
        merged_vertices,
        flipped_faces,
        inverted_shells,
        degenerate_dropped: _,
    } = *repairs;
    let rows = [
        ("duplicate_triangles", duplicates_dropped, "triangle", "standing there twice, dropped".to_owned()),
        (
            "merged_vertices",
            merged_vertices,
            "corner",
            format!("less than {MERGE_MM} mm from another one, merged"),
        ),
        ("flipped_faces", flipped_faces, "triangle", "facing the wrong way, turned".to_owned()),
        ("inverted_shells", inverted_shells, "shell", "inside out, turned".to_owned()),
    ];
    let found = rows.into_iter().filter(|(_, count, ..)| *count > 0);
    found
        .map(|(code, count, noun, what)| Warning {
            code,
            message: format!("{} {what}", counted(count as u64, noun)),
        })
        .collect()
}

fn condition_warnings(condition: &Condition) -> Vec<Warning> {
    let Condition { open_edges, unbalanced_edges, twisted_edges, .. } = *condition;
    let rows = [
        ("open_edges", open_edges, "the surface has a hole there, and layers are closed by guess"),
        (
            "non_manifold_edges",
            unbalanced_edges,
            "several surfaces meet there, and it is not clear what is inside",
        ),
        ("twisted_edges", twisted_edges, "inside and outside meet there, as on a Moebius strip"),
    ];
    let kind = |code| if code == "open_edges" { "open edge" } else { "faulty edge" };
    let found = rows.into_iter().filter(|(_, count, _)| *count > 0);
    found
        .map(|(code, count, what)| Warning {
            code,
            message: format!("{}: {what}", counted(count as u64, kind(code))),
        })
        .collect()
}

/// A surface that encloses nothing cannot be printed.
fn volume_warning(inspection: &Inspection) -> Vec<Warning> {
    /// Volume of a sheet by rounding alone, as a share of its area's cube of edge length.
    const FLAT: f64 = 1e-9;
    let is_flat = inspection.volume_mm3.abs() <= FLAT * inspection.area_mm2 * inspection.area_mm2.sqrt();
    let message = "the surface encloses no volume".to_owned();
    is_flat.then_some(Warning { code: "no_volume", message }).into_iter().collect()
}

/// A part so small that its file counts another unit, perhaps; the size is never changed for it.
fn unit_warning(bounds: &Extent) -> Option<Warning> {
    /// Parts with no side longer than this are metres, mm: a third of a metre at most.
    const METRES: f32 = 0.35;
    /// The like for inches: four of them. Few prints are smaller than 4 mm.
    const INCHES: f32 = 4.0;
    let longest = (0..3).map(|i| bounds.max[i] - bounds.min[i]).fold(0.0, f32::max);
    let (code, unit, factor) = match longest {
        l if l <= METRES => ("unit_metre", "metres", 1000.0),
        l if l <= INCHES => ("unit_inch", "inches", 25.4),
        _ => return None,
    };
    let message = format!(
        "its longest side has {longest:.3} mm: perhaps the file counts {unit}; {factor} times as large it has {:.1} mm",
        longest * factor
    );
    Some(Warning { code, message })
}

/// "1 triangle", "2 triangles".
fn counted(count: u64, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}
