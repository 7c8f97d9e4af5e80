//! How the viewer lays a recording out: the mechanism large, its plots beside it, the panels folded away.

use rerun::blueprint::components::{LoopMode, PanelState, PlayState};
use rerun::blueprint::{
    Blueprint, BlueprintPanel, ContainerLike, Horizontal, SelectionPanel, Spatial2DView, Spatial3DView,
    TimePanel, TimeSeriesView, Vertical,
};

use super::TIMELINE;

/// The layout of a recording.
pub(super) fn blueprint() -> Blueprint {
    let mechanism = Spatial3DView::new("Mechanism").with_origin("/world").with_contents(["/world/**"]);
    let plot = |name: &str, origin: &str| {
        let contents = format!("{origin}/**");
        ContainerLike::from(TimeSeriesView::new(name).with_origin(origin).with_contents([contents]))
    };
    let jacobian = Spatial2DView::new("Jacobian: rows × coordinates").with_origin("/jacobian");
    let plots = Vertical::new([
        plot("Energy in J", "/plots/energy"),
        plot("Constraint violation in m, m/s", "/plots/violation"),
        plot("Multipliers of the joints", "/plots/multipliers"),
        jacobian.into(),
    ]);
    let columns: [ContainerLike; 2] = [mechanism.into(), plots.into()];
    Blueprint::new(Horizontal::new(columns).with_column_shares([2.0, 1.0]))
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
