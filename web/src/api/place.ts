// Where runs are computed: on the server, or by the engine in this page.
import { site } from "../core/address";
import { recall, remember } from "../core/prefs";
import { canComputeHere } from "../engine/here";

/** Whether both are possible, so that one can choose. */
export const canChoosePlace = (): boolean => !site && canComputeHere();

/** Whether runs are computed in this page: chosen so, or there is no server. What counts is never graded by them. */
export const computedHere = (): boolean => site || (recall("computed") === "here" && canComputeHere());

/** Computes runs here from now on, or on the server. */
export function computeHere(here: boolean): void {
  remember("computed", here ? "here" : null);
}
