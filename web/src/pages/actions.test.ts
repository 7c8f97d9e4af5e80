import { describe, expect, it } from "vitest";
import { actionNamed, actionsOf } from "./actions";

describe("what a step asks for", () => {
  const asked = (text: string): unknown[] =>
    actionsOf(text).map(({ from, to, action }) => [text.slice(from, to), action]);

  it("is found where lessons write it", () => {
    expect(asked("Reset and run to 2 s. Read the position.")).toEqual([
      ["Reset", { do: "reset" }],
      ["run to 2 s", { do: "run", time: 2 }],
    ]);
    expect(asked("and follow the corner. Stop at 0.5 s.")).toEqual([
      ["Stop at 0.5 s", { do: "run", time: 0.5 }],
    ]);
    expect(asked("Open the Jacobian in the inspector. Open the multipliers of the joint")).toEqual([
      ["Open the Jacobian", { do: "panel", panel: "jacobian" }],
      ["Open the multipliers", { do: "panel", panel: "multipliers" }],
    ]);
    expect(asked("Run the scene to 5 s and note. Play at a low speed to 0.7 s.")).toEqual([
      ["Run the scene to 5 s", { do: "run", time: 5 }],
      ["Play at a low speed to 0.7 s", { do: "run", time: 0.7 }],
    ]);
  });

  it("is nothing where none is meant", () => {
    expect(asked("Compare 2 s with 5 s; the presets stay, open the scene as text.")).toEqual([]);
  });

  it("is a control or a panel where its name stands in bold", () => {
    expect(actionNamed("Play")).toEqual({ do: "play" });
    expect(actionNamed("State")).toEqual({ do: "panel", panel: "state" });
    expect(actionNamed("is")).toBeUndefined();
  });
});
