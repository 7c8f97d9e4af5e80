// Every body as numbers: what the 3-D view shows, for eyes and ears that do without it.

import type { Vec3 } from "../api/types";
import { h, setText } from "../core/dom";
import { fixed, seconds } from "../core/format";
import { t } from "../core/texts";
import { norm } from "../mechanics/vec";
import type { Session } from "../session/session";
import type { Panel } from "../ui/panel";
import { liveTable } from "../ui/table";
import { OF_BODIES, worthLine } from "./accuracy";

const xyz = (a: Vec3, decimals = 4): string[] => a.map((part) => fixed(part, decimals));

export function bodiesTab(session: Session): Panel {
  const column = (label: string, unit?: string): { label: string; unit?: string; number: boolean } => ({
    label,
    number: true,
    ...(unit ? { unit } : {}),
  });
  const places = liveTable(t("Centre of mass and its velocity, in the world frame"), t("Body"), [
    column("x", "m"),
    column("y", "m"),
    column("z", "m"),
    column("vx", "m/s"),
    column("vy", "m/s"),
    column("vz", "m/s"),
    column(t("speed"), "m/s"),
  ]);
  const turns = liveTable(t("Angular velocity, in the world frame"), t("Body"), [
    column("ωx", "rad/s"),
    column("ωy", "rad/s"),
    column("ωz", "rad/s"),
    column("|ω|", "rad/s"),
  ]);
  const axes = liveTable(t("Principal axes u, v, w of each body, in the world frame"), t("Axis"), [
    column("x"),
    column("y"),
    column("z"),
  ]);

  const when = h("p", { class: "when" });
  const worth = worthLine(OF_BODIES);

  const refresh = (): void => {
    const state = session.lastRecorded;
    const bodies = state?.bodies ?? [];
    if (state) setText(when, t("At {time}.", { time: seconds(state.time) }));
    // Errors are told with states; between two of them, those of the one before it.
    if (session.shown) worth.show(session.shown);
    places.update(
      bodies.map((body) => ({
        head: body.name,
        cells: [...xyz(body.position), ...xyz(body.velocity), fixed(norm(body.velocity), 4)],
      })),
    );
    turns.update(
      bodies.map((body) => ({
        head: body.name,
        cells: [...xyz(body.angular_velocity), fixed(norm(body.angular_velocity), 4)],
      })),
    );
    axes.update(
      bodies.flatMap((body) =>
        (["u", "v", "w"] as const).map((name) => ({ head: `${body.name} ${name}`, cells: xyz(body[name]) })),
      ),
    );
  };
  return {
    root: h("div", { class: "stack" }, when, worth.root, places.root, turns.root, axes.root),
    refresh,
  };
}
