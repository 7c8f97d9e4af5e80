// What the run will show, asked before it runs: the controls wait until every prediction is made or skipped. Afterwards
// one's own prediction stands beside what happened.

import { api } from "../api/client";
import { inClass, me, teaches } from "../api/identity";
import { tidy } from "../api/numbers";
import type { GivenPrediction, Lesson, Prediction } from "../api/types";
import { announce, authored, h } from "../core/dom";
import { seconds } from "../core/format";
import { setMaths } from "../core/maths";
import { student } from "../core/prefs";
import { t } from "../core/texts";
import type { Session } from "../session/session";
import { problemNotice } from "../ui/notice";
import { setStudent } from "../ui/shell";
import { PredictionForm, type Said } from "./form";

/** Something that stands before a run. */
export interface Asked {
  root: HTMLElement;
  /** Holds the run until it is given. */
  hold: (session: Session) => void;
  given: Promise<void>;
}

export class PredictionPanel implements Asked {
  readonly root = h("section", { class: "prediction", "aria-label": t("Prediction"), id: "prediction" });
  readonly given: Promise<void>;
  private opened: () => void = () => undefined;
  private session: Session | undefined;
  private readonly kept = new Map<string, GivenPrediction>();
  private readonly revealed = new Set<string>();
  /** Skipped by somebody without a name: kept by nobody, and asked again in another visit. */
  private readonly passed = new Set<string>();
  private form: PredictionForm | undefined;
  /** The predictions that the run was about when all was painted. */
  private painted = "";
  private readonly undo: (() => void)[] = [];
  /** Another name: what that one has predicted. */
  private readonly renamed = (): void => void this.load();

  constructor(private readonly lesson: Lesson) {
    this.given = new Promise((done) => {
      this.opened = done;
    });
    addEventListener("triad:student", this.renamed);
  }

  hold(session: Session): void {
    this.session = session;
    // Who teaches shows the run to others, and who is not of the class has none.
    if (inClass() && (teaches() || !me().person)) {
      this.opened();
      return;
    }
    session.hold(() => this.ask());
    this.undo.push(
      session.on("shown", () => this.reveal()),
      // Which run it is changes with its numbers.
      session.on("scene", () => this.reveal()),
    );
    void this.load();
  }

  dispose(): void {
    removeEventListener("triad:student", this.renamed);
    for (const step of this.undo) step();
  }

  private get missing(): Prediction | undefined {
    return this.lesson.predictions.find((one) => !this.kept.has(one.id) && !this.passed.has(one.id));
  }

  private async load(): Promise<void> {
    const name = student.get();
    try {
      const found = name ? await api.predictions(this.lesson.slug, name) : [];
      this.kept.clear();
      for (const one of found) this.kept.set(one.prediction, one);
      // Another run than the one that shows it: that one was seen in an earlier visit.
      for (const one of this.lesson.predictions)
        if (one.with && this.kept.has(one.id)) this.revealed.add(one.id);
      this.paint();
    } catch (error) {
      this.root.replaceChildren(
        problemNotice(error, [{ label: t("Try again"), run: () => void this.load() }]),
      );
    }
  }

  /** The run was to go on: says what it waits for. */
  private ask(): void {
    announce(t("The run waits: say first what you expect, or skip."));
    this.root.scrollIntoView({ block: "nearest" });
    this.form?.focus();
  }

  private paint(): void {
    const { missing } = this;
    this.form =
      missing &&
      new PredictionForm(missing, `why:${this.lesson.slug}:${missing.id}`, (given) =>
        this.give(missing, given),
      );
    this.painted = this.runs;
    this.root.replaceChildren(
      ...[...this.kept.values()].map((one) => this.result(one)).filter((part) => part !== null),
      ...(this.form ? [this.form.root] : []),
    );
    void setMaths(this.root);
    if (missing) return;
    this.session?.release();
    this.opened();
    this.reveal();
  }

  private async give(asked: Prediction, { name, ...given }: Said): Promise<void> {
    if (name) {
      const kept = await api.predict(this.lesson.slug, { student: name, prediction: asked.id, ...given });
      this.kept.set(asked.id, kept);
      announce(
        kept.choice
          ? t("Your prediction is kept. Now run it.")
          : t("Skipped, and kept as skipped. Now run it."),
      );
    } else {
      this.passed.add(asked.id);
      announce(t("Skipped without a name: nothing is kept. Now run it."));
    }
    const { session } = this;
    if (asked.with && session) {
      const { values, places } = session.numbers;
      await session.change({ values: { ...values, ...asked.with }, places });
    }
    this.paint();
    this.root.querySelector<HTMLElement>(".prediction-result")?.focus();
    if (name) setStudent(name);
  }

  /** Whether the run is the one that was asked about: with the author's numbers and those of the prediction, from its start. */
  private runsAs(asked: Prediction): boolean {
    const { session } = this;
    if (!session || session.altered) return false;
    const { values, places } = session.numbers;
    const set = { values: asked.with ?? {}, places: {} };
    const wanted = (session.view ? tidy(set, session.view) : set).values;
    const names = new Set([...Object.keys(values), ...Object.keys(wanted)]);
    return Object.keys(places).length === 0 && [...names].every((name) => values[name] === wanted[name]);
  }

  /** The predictions that the run is about. */
  private get runs(): string {
    return this.lesson.predictions
      .filter((one) => this.runsAs(one))
      .map(({ id }) => id)
      .join();
  }

  /** Shows what happened as soon as the run that was asked about has shown it. */
  private reveal(): void {
    const state = this.session?.latest;
    if (!state || this.missing) return;
    if (this.runs !== this.painted) this.paint();
    const seen = this.lesson.predictions.filter(
      (one) =>
        !this.revealed.has(one.id) &&
        (state.finished || (state.time > 0 && state.time >= one.seen_at)) &&
        this.runsAs(one),
    );
    if (seen.length === 0) return;
    for (const one of seen) this.revealed.add(one.id);
    this.paint();
    announce(this.root.textContent ?? "");
  }

  private result(kept: GivenPrediction): HTMLElement | null {
    const asked = this.lesson.predictions.find((one) => one.id === kept.prediction);
    if (!asked) return null;
    const option = (id: string | null | undefined): HTMLElement =>
      authored(
        h("span", { class: "prediction-option" }),
        asked.options.find((one) => one.id === id)?.html ?? "",
      );
    const own = kept.choice
      ? h("p", null, h("b", null, t("You predicted:"), " "), option(kept.choice))
      : h("p", null, h("b", null, t("You skipped the prediction.")));
    const shown = this.revealed.has(asked.id);
    const same = this.runsAs(asked);
    const happened = same ? t("What happened:") : t("What happened in the run that was asked about:");
    return h(
      "div",
      { class: "prediction-result", tabindex: "-1" },
      authored(h("div", { class: "prediction-asked" }), asked.html),
      own,
      kept.why ? h("p", { class: "prediction-why" }, `“${kept.why}”`) : null,
      shown ? h("p", null, h("b", null, happened, " "), option(kept.outcome.happens)) : null,
      shown
        ? authored(h("div", { class: "prediction-shows" }), kept.outcome.html)
        : h("p", { class: "help" }, same ? waitsFor(asked) : waitsForOther(asked)),
    );
  }
}

/** This run has other numbers than the one that was asked about. */
const waitsForOther = ({ with: values }: Prediction): string =>
  Object.keys(values ?? {}).length > 0
    ? t(
        "This run is not the one that was asked about: set the numbers of the question and run it from the start.",
      )
    : t("This run is not the one that was asked about: run it from the start as its author wrote it.");

function waitsFor(asked: Prediction): string {
  return asked.seen_at > 0
    ? t("Run it: at {seen_at} you will have seen it.", { seen_at: seconds(asked.seen_at) })
    : t("Run it, and you will see.");
}
