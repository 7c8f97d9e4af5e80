import { t } from "../core/texts";

/** The 3-D view cannot run in this browser; the message says why, for a reader. */
export class ViewerUnavailable extends Error {}

/** Renderers that draw on the processor, not on a graphics card. */
const SOFTWARE = /swiftshader|llvmpipe|lavapipe|softpipe|software|basic render|warp/i;

/** Whether 3-D is drawn without a graphics card here: slowly, then. The browser's own word on it is not to be relied on. */
export function drawsInSoftware(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  const names = context?.getExtension("WEBGL_debug_renderer_info");
  const name = context && names ? String(context.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return SOFTWARE.test(name);
}

/** Asked before 11 MB are fetched for nothing. */
export function requireWebGl(): void {
  const context = document.createElement("canvas").getContext("webgl2");
  if (!context)
    throw new ViewerUnavailable(t("The 3-D view needs WebGL 2, which this browser does not offer."));
  context.getExtension("WEBGL_lose_context")?.loseContext();
}
