//! How the viewer lays a recording out: the mechanism large, each plot as large behind a tab of its own, the panels folded away.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use re_sdk_types::blueprint::archetypes::{Background, EyeControls3D};
use re_sdk_types::blueprint::components::{BackgroundKind, LoopMode, PanelState, PlayState};
use re_sdk_types::components::Color;
use rerun::blueprint::{
    Blueprint, BlueprintPanel, ContainerLike, SelectionPanel, Spatial2DView, Spatial3DView, Tabs, TimePanel,
    TimeSeriesView,
};
use rerun::external::re_log_types::{BlueprintActivationCommand, StoreId, StoreKind};
use rerun::log::{Chunk, LogMsg, RowId};
use rerun::time::{TimePoint, Timeline};
use rerun::{RecordingStream, RecordingStreamBuilder, RecordingStreamResult};

use triad_session::drawing::Camera;
use triad_session::picture::SceneDescription;

use super::geometry::single;
use super::{APPLICATION, TIMELINE};

/// What is behind the mechanism: a calm grey, as the viewer's own colours would be the strongest of the page. One recording is
/// seen in light and dark pages.
const BACKGROUND: [u8; 3] = [201, 209, 218];

/// Sends the layout, and makes the viewer use it.
pub(super) fn send(
    recording: &RecordingStream,
    description: &SceneDescription,
    from: Camera,
) -> RecordingStreamResult<()> {
    let layout = Layout::next()?;
    let id = StoreId::random(StoreKind::Blueprint, APPLICATION);
    let mut messages = layout.messages.clone();
    for message in &mut messages {
        message.set_store_id(id.clone());
    }
    let now = TimePoint::from([(Timeline::new_sequence("blueprint"), 0)]);
    let eye = eye(description, from);
    let [r, g, b] = BACKGROUND;
    let background = Background::new(BackgroundKind::SolidColor).with_color(Color::from_rgb(r, g, b));
    let of_view = |what: &str| Chunk::builder(format!("{}/{what}", layout.view));
    let chunks = [
        of_view("EyeControls3D").with_archetype(RowId::new(), now.clone(), &eye),
        of_view("Background").with_archetype(RowId::new(), now, &background),
    ];
    for chunk in chunks {
        messages.push(LogMsg::ArrowMsg(id.clone(), chunk.build()?.to_arrow_msg()?));
    }
    let activation = BlueprintActivationCommand { blueprint_id: id, make_active: true, make_default: true };
    recording.send_blueprint(messages, activation);
    Ok(())
}

/// The layout as messages, all but what the mechanism's view looks like.
struct Layout {
    messages: Vec<LogMsg>,
    /// Where the mechanism's view is described.
    view: String,
}

/// Two layouts that differ in the names of their views alone, made once: the library writes a layout only into a
/// recording in memory of its own, whose threads it never ends.
static LAYOUTS: [OnceLock<Layout>; 2] = [OnceLock::new(), OnceLock::new()];

impl Layout {
    /// The two in turn: a view of another name forgets how the last one was turned by hand.
    fn next() -> RecordingStreamResult<&'static Self> {
        static TURN: AtomicUsize = AtomicUsize::new(0);
        let kept = &LAYOUTS[TURN.fetch_add(1, Ordering::Relaxed) % LAYOUTS.len()];
        match kept.get() {
            Some(layout) => Ok(layout),
            None => Self::new().map(|layout| kept.get_or_init(|| layout)),
        }
    }

    fn new() -> RecordingStreamResult<Self> {
        let mechanism = Spatial3DView::new("Mechanism").with_origin("/world").with_contents(["/world/**"]);
        let mechanism = ContainerLike::from(mechanism);
        let view = match &mechanism {
            ContainerLike::View(view) => view.blueprint_path().to_string(),
            _ => String::new(),
        };
        let (scratch, written) =
            RecordingStreamBuilder::new(APPLICATION).with_blueprint(blueprint(mechanism, &view)).memory()?;
        let is_layout = |message: &LogMsg| {
            message.store_id().kind() == StoreKind::Blueprint
                && !matches!(message, LogMsg::BlueprintActivationCommand(_))
        };
        let messages = written.take().into_iter().filter(is_layout).collect();
        // A stream and its place in memory hold each other: without this, both stay, with their threads.
        scratch.disconnect();
        Ok(Self { messages, view })
    }
}

/// A camera that sees the whole mechanism.
fn eye(description: &SceneDescription, from: Camera) -> EyeControls3D {
    let direction = match (from, description.y_is_up()) {
        (Camera::Corner, true) => [0.35, 0.3, 2.5],
        (Camera::Corner, false) => [1.5, -1.9, 1.1],
        (Camera::Front, true) => [0.0, 0.0, 2.6],
        (Camera::Front, false) => [0.0, -2.6, 0.0],
        (Camera::Side, _) => [2.6, 0.0, 0.0],
        // Not quite along the upward axis, which would leave the turn of the picture about it undetermined.
        (Camera::Above, true) => [0.0, 2.6, 0.02],
        (Camera::Above, false) => [0.0, -0.02, 2.6],
    };
    let position: [f64; 3] =
        std::array::from_fn(|k| description.center[k] + 0.9 * description.reach * direction[k]);
    let up = if description.y_is_up() { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
    EyeControls3D::new()
        .with_position(single(position))
        .with_look_target(single(description.center))
        .with_eye_up(single(up))
}

/// Beside the mechanism the plots were cut: of the stage of a page they had a quarter each of a third.
fn blueprint(mechanism: ContainerLike, shown_first: &str) -> Blueprint {
    let plot = |name: &str, origin: &str| {
        let contents = format!("{origin}/**");
        ContainerLike::from(TimeSeriesView::new(name).with_origin(origin).with_contents([contents]))
    };
    // All names stand beside each other above a stage of 700 pixels.
    let jacobian = Spatial2DView::new("Jacobian").with_origin("/jacobian");
    let tabs = Tabs::new([
        mechanism,
        plot("Energy, J", "/plots/energy"),
        plot("Violation, m and m/s", "/plots/violation"),
        plot("Multipliers", "/plots/multipliers"),
        jacobian.into(),
    ]);
    Blueprint::new(tabs.with_active_tab(shown_first))
        .with_auto_views(false)
        .with_auto_layout(false)
        .with_blueprint_panel(BlueprintPanel::from_state(PanelState::Hidden))
        .with_selection_panel(SelectionPanel::from_state(PanelState::Hidden))
        .with_time_panel(
            TimePanel::new()
                .with_state(PanelState::Collapsed)
                .with_timeline(TIMELINE)
                .with_play_state(PlayState::Following)
                .with_loop_mode(LoopMode::Off),
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Side by side the plots were cut: whichever is looked at has the whole stage, at first the mechanism.
    #[test]
    fn views_stand_behind_tabs_and_the_mechanism_in_front() {
        let layout = Layout::new().expect("a layout");
        let columns = layout.messages.iter().flat_map(|message| match message {
            LogMsg::ArrowMsg(_, arrow) => {
                arrow.batch.schema().fields().iter().map(|field| field.name().clone()).collect()
            }
            _ => Vec::new(),
        });
        assert!(columns.into_iter().any(|name| name.contains("active_tab")));
    }
}
