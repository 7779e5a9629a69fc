//! Plans and shaders: what is read was written before, and lies where Rust puts it.

use super::examples::examples_of_all;
use super::strokes::all_strokes;
use super::strokes::drawn;
use super::*;

/// What a plan reads of its own before a step of it has written that.
fn unwritten(plan: &Plan) -> Vec<String> {
    let (mut written, mut early) = (BTreeSet::new(), Vec::new());
    for step in &plan.steps {
        for bind in step.binds() {
            match bind {
                Bind::Scratch(number) if !written.contains(number) => early.push(format!("{number} by {step:?}")),
                Bind::Drawn(drawn) => early.extend(unwritten(&drawn.plan)),
                // Arrays are all 0 at first, which is what a routine adds to.
                Bind::Written(number) => drop(written.insert(*number)),
                Bind::Scratch(_) | Bind::Bytes(_) | Bind::List(_) | Bind::Upload(..) | Bind::Depth | Bind::Linear => {}
            }
        }
        match step {
            Step::Compute(Compute { groups: Groups::Found(tally), .. }) if !written.contains(tally) => {
                early.push(format!("tally {tally} by {step:?}"));
            }
            Step::Compute(_) => {}
            Step::Draw(draw) => {
                let tally = draw.found.filter(|tally| !written.contains(tally));
                early.extend(tally.map(|tally| format!("tally {tally} by {step:?}")));
                let into = draw.into.iter();
                written
                    .extend(into.flat_map(|into| into.textures.iter().map(|(number, _)| *number).chain(into.depths)));
            }
        }
    }
    early
}

#[test]
fn what_a_plan_reads_of_its_own_was_written_before() {
    let (plain, mut seen) = (json!({"kind": "plain", "color": "#c8b8a0c0"}), 0);
    let strokes = all_strokes().into_iter().map(|own| drawn(&own, &plain));
    let examples = examples_of_all().into_iter().map(|(_, scene, own)| render::synth(&scene, &own, None).unwrap());
    for synth in examples.chain(strokes) {
        for layer in &synth.layers {
            let plan = layer.plan(&synth.moment(0.3));
            seen += plan.scratch.len();
            assert_eq!(unwritten(&plan), [""; 0]);
        }
    }
    assert!(seen > 100, "{seen}");
}

/// The name and the WGSL of all shaders of a kind.
fn shaders(kind: &Kind) -> impl Iterator<Item = (&'static str, String)> {
    let programs = kind.programs.iter().copied().flatten().map(|program| (program.name, program.text()));
    programs.chain(kind.routines.iter().map(|routine| (routine.name, routine.text())))
}

/// The members of a struct that mean something, with where they begin; and its size.
fn layout(found: &Type) -> (Vec<(String, usize)>, usize) {
    let TypeInner::Struct { members, span } = &found.inner else { panic!("{found:?}") };
    let named = members.iter().map(|member| (member.name.clone().unwrap(), member.offset as usize));
    (named.filter(|(name, _)| name != "unused").collect(), *span as usize)
}

#[test]
fn what_shaders_read_lies_where_rust_puts_it() {
    for kind in KINDS {
        let twins: Vec<_> = kind.twins.iter().copied().flatten().collect();
        let mut seen = BTreeSet::new();
        for (shader, text) in shaders(kind) {
            let module = wgsl::parse_str(&text).unwrap();
            let uniforms = module.global_variables.iter().filter(|(_, of)| of.space == AddressSpace::Uniform);
            for (_, uniform) in uniforms {
                let name = module.types[uniform.ty].name.as_deref();
                assert!(twins.iter().any(|twin| Some(twin.name) == name), "{shader}: Rust knows no {name:?}");
            }
            let strides = module.types.iter().filter_map(|(_, found)| match found.inner {
                TypeInner::Array { base, stride, .. } => Some((module.types[base].name.as_deref()?, stride as usize)),
                _ => None,
            });
            let strides: Vec<_> = strides.collect();
            for twin in &twins {
                let Some((_, found)) = module.types.iter().find(|(_, found)| found.name.as_deref() == Some(twin.name))
                else {
                    continue;
                };
                let (members, span) = layout(found);
                let fields: Vec<_> = twin.fields.iter().map(|(name, at)| ((*name).to_owned(), *at)).collect();
                assert_eq!(members, fields, "{shader}: {}", twin.name);
                assert!((span..span + 16).contains(&twin.size), "{shader}: {}: {span}, {}", twin.name, twin.size);
                let stride = strides.iter().find(|(name, _)| *name == twin.name);
                assert!(stride.is_none_or(|(_, stride)| *stride == twin.size), "{shader}: {}", twin.name);
                seen.insert(twin.name);
            }
        }
        assert_eq!(seen.len(), twins.len(), "{}: {seen:?}", kind.name);
    }
}

#[test]
fn every_shader_is_valid() {
    let own = render::gpu::PROGRAMS.iter().map(|program| (program.name, program.text()));
    let window = [plica::layers::parts::plan::COMMON, include_str!("../../src/preview/window/screen.wgsl")].concat();
    for (name, source) in KINDS.iter().flat_map(|kind| shaders(kind)).chain(own).chain([("screen.wgsl", window)]) {
        let source = source.as_str();
        let module = wgsl::parse_str(source).unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(source)));
        let mut validator = valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::empty());
        validator.validate(&module).unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(source)));
    }
}
