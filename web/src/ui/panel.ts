// A panel that shows a run.

export interface Panel {
  root: HTMLElement;
  /** Called when what is shown has changed, and when the panel is opened. */
  refresh: () => void;
}
