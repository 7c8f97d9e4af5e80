/** The 3-D view cannot run in this browser; the message says why, for a reader. */
export class ViewerUnavailable extends Error {}

/** Asked before 11 MB are fetched for nothing. */
export function requireWebGl(): void {
  const context = document.createElement("canvas").getContext("webgl2");
  if (!context) throw new ViewerUnavailable("The 3-D view needs WebGL 2, which this browser does not offer.");
  context.getExtension("WEBGL_lose_context")?.loseContext();
}
