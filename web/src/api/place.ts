// Where runs are computed: on the server, or by the engine in this page.
import { site } from "../core/address";
import { recall, remember } from "../core/prefs";
import { canComputeHere } from "../engine/here";

/** Whether both are possible, so that one can choose. */
export const canChoosePlace = (): boolean => !site && canComputeHere();

/** The server had no place for another run: until this page is left, it computes. */
let lent = false;

/** Whether runs are computed in this page: chosen so, or there is no server, or none with a place. What counts is never graded by
 * them. */
export const computedHere = (): boolean =>
  site || ((lent || recall("computed") === "here") && canComputeHere());

/** Computes runs here from now on, or on the server. */
export function computeHere(here: boolean): void {
  remember("computed", here ? "here" : null);
}

/** Computes runs here for as long as this page is open; it is told by `triad:place`. */
export function computeHereMeanwhile(): void {
  lent = true;
  dispatchEvent(new Event("triad:place"));
}
