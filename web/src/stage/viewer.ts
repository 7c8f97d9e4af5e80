// The rerun viewer, fetched when it is wanted, kept alive between pages, fed by our own socket.

import type { LogChannel, WebViewer } from "@rerun-io/web-viewer";
import { t } from "../core/texts";
import { theme } from "../core/theme";
import { requireWebGl } from "./unavailable";

const TIMELINE = "time";
const NANOSECONDS = 1e9;

export interface ViewerHandle {
  send: (block: Uint8Array) => void;
  /** Shows the recording at a time in seconds. */
  show: (time: number) => void;
  /** Up to which time, in seconds, the viewer has taken the recording in; `undefined` while it has none. */
  taken: () => number | undefined;
  /** The next blocks belong to a recording that begins anew. */
  begin: () => void;
  close: () => void;
}

export interface ViewerHooks {
  progress: (fraction: number) => void;
  selected: (entityPath: string) => void;
}

/** Starts the viewer inside `host`. Rejects with a sentence when this browser cannot run it. */
export async function openViewer(host: HTMLElement, hooks: ViewerHooks): Promise<ViewerHandle> {
  requireWebGl();
  silenceDetails();
  const { WebViewer } = await import("@rerun-io/web-viewer");
  const viewer = new WebViewer();
  const restore = watchDownload(hooks.progress);
  const tamed = tameFocus(host);
  try {
    await viewer.start(null, host, {
      width: "100%",
      height: "100%",
      hide_welcome_screen: true,
      render_backend: "webgl",
      allow_fullscreen: false,
      theme: theme(),
    });
  } finally {
    restore();
    tamed();
  }
  viewer.canvas?.setAttribute("role", "img");
  viewer.canvas?.setAttribute(
    "aria-label",
    t("3-D view of the mechanism. Its numbers stand in the tables of the inspector."),
  );
  for (const panel of ["top", "blueprint", "selection", "time"] as const)
    viewer.override_panel_state(panel, "hidden");
  return handle(viewer, hooks);
}

function handle(viewer: WebViewer, hooks: ViewerHooks): ViewerHandle {
  let channel: LogChannel | undefined;
  let recording: string | null = null;
  let wanted: number | undefined;
  let opened = 0;

  viewer.on("recording_open", (event) => {
    if (event.application_id !== "triad") return;
    recording = event.recording_id;
    viewer.set_active_recording_id(event.recording_id);
    settle();
  });
  viewer.on("selection_change", (event) => {
    for (const item of event.items) if (item.type === "entity") hooks.selected(item.entity_path);
  });

  /** The page's clock is the only one: the viewer stands at the time that the page shows. */
  const settle = (): void => {
    if (recording === null || wanted === undefined) return;
    if (viewer.get_active_timeline(recording) !== TIMELINE) viewer.set_active_timeline(recording, TIMELINE);
    // Its own clock would run on from there, or follow the newest block.
    if (viewer.get_playing(recording)) viewer.set_playing(recording, false);
    viewer.set_current_time(recording, TIMELINE, Math.round(wanted * NANOSECONDS));
  };

  return {
    begin: () => {
      recording = null;
      channel?.close();
      opened += 1;
      channel = viewer.open_channel(`triad-${opened}`);
    },
    send: (block) => channel?.send_rrd(block),
    show: (time) => {
      wanted = time;
      settle();
    },
    taken: () => {
      const range = recording === null ? null : viewer.get_time_range(recording, TIMELINE);
      return range ? range.max / NANOSECONDS : undefined;
    },
    close: () => {
      channel?.close();
      viewer.stop();
    },
  };
}

/**
 * The viewer describes its shaders word by word, some 24 000 lines, and has no option for less: where somebody listens to the console,
 * it would start a quarter of a minute later.
 */
function silenceDetails(): void {
  console.debug = () => {};
}

/**
 * The viewer measures its download against the packed length and would stand at 100 % early.
 * While it starts, its one .wasm request is counted here against the true length.
 */
function watchDownload(progress: (fraction: number) => void): () => void {
  const original = window.fetch;
  window.fetch = async (input, init) => {
    const response = await original(input, init);
    const url = input instanceof Request ? input.url : String(input);
    if (!url.endsWith(".wasm") || !response.ok || !response.body) return response;
    let received = 0;
    const counted = response.body.pipeThrough(
      new TransformStream<Uint8Array, Uint8Array>({
        transform(chunk, controller) {
          received += chunk.byteLength;
          progress(Math.min(1, received / __VIEWER_BYTES__));
          controller.enqueue(chunk);
        },
      }),
    );
    return new Response(counted, { status: response.status, headers: response.headers });
  };
  return () => {
    window.fetch = original;
  };
}

/**
 * The viewer focuses its canvas, and the hidden input that it adds to the page for text, as it likes: whoever reads or
 * types elsewhere would lose the focus and the place. Both take it only after a press inside the viewer, and never
 * scroll. Returns what ends the search for these elements.
 */
function tameFocus(host: HTMLElement): () => void {
  let inside = false;
  document.addEventListener(
    "pointerdown",
    (event) => {
      inside = event.target instanceof Node && host.contains(event.target);
    },
    { capture: true },
  );
  const tame = (element: HTMLElement): void => {
    element.autofocus = false;
    element.focus = () => {
      if (inside) HTMLElement.prototype.focus.call(element, { preventScroll: true });
    };
  };
  const find = (): void => {
    host.querySelectorAll("canvas").forEach(tame);
    for (const agent of document.querySelectorAll<HTMLElement>(":scope > body > input")) {
      tame(agent);
      agent.tabIndex = -1;
      agent.setAttribute("aria-hidden", "true");
    }
  };
  const watch = new MutationObserver(find);
  watch.observe(host, { childList: true, subtree: true });
  watch.observe(document.body, { childList: true });
  return () => {
    find();
    watch.disconnect();
  };
}
