// Line icons drawn on a 20 × 20 grid. Decoration only: names are given by the controls.

const PATHS = {
  play: '<path d="M6.5 4.2v11.6L15.6 10z" fill="currentColor"/>',
  pause: '<path d="M6 4.5h2.6v11H6zM11.4 4.5H14v11h-2.6z" fill="currentColor" stroke="none"/>',
  step: '<path d="M4.5 5v10l6.8-5z" fill="currentColor"/><path d="M14.5 4.6v10.8"/>',
  skip: '<path d="M3.5 5.4v9.2L9 10zM10 5.4v9.2l5.5-4.6z" fill="currentColor"/>',
  back: '<path d="M15.5 5v10l-6.8-5z" fill="currentColor"/><path d="M5.5 4.6v10.8"/>',
  reset: '<path d="M4.6 8.2A6 6 0 1 1 4 11"/><path d="M4.2 4.2v4.2h4.2"/>',
  live: '<path d="M4 5v10l6-5zM10 5v10l6-5z" fill="currentColor"/>',
  loop: '<path d="M4 9.5V8a3 3 0 0 1 3-3h8.5M16 10.5V12a3 3 0 0 1-3 3H4.5"/><path d="m13 2.4 2.6 2.6L13 7.6M7 12.4 4.4 15 7 17.6"/>',
  lecture:
    '<circle cx="10" cy="5.4" r="2.6"/><path d="M5 16v-2.4A3.6 3.6 0 0 1 8.6 10h2.8a3.6 3.6 0 0 1 3.6 3.6V16M2.4 16v-1.4M17.6 16v-1.4M3.4 11.4v.1M16.6 11.4v.1"/>',
  sun: '<circle cx="10" cy="10" r="3.4"/><path d="M10 2.4v2M10 15.6v2M2.4 10h2M15.6 10h2M4.6 4.6 6 6M14 14l1.4 1.4M15.4 4.6 14 6M6 14l-1.4 1.4"/>',
  moon: '<path d="M16 11.9A6.6 6.6 0 0 1 8.1 4a6.6 6.6 0 1 0 7.9 7.9z"/>',
  person:
    '<circle cx="10" cy="6.6" r="3.2"/><path d="M3.8 16.8v-.8a4.6 4.6 0 0 1 4.6-4.6h3.2a4.6 4.6 0 0 1 4.6 4.6v.8"/>',
  keys: '<rect x="2.5" y="5.5" width="15" height="9" rx="1.6"/><path d="M5.5 8.5h.1M8.5 8.5h.1M11.5 8.5h.1M14.5 8.5h.1M6.5 11.6h7"/>',
  check: '<path d="m4.4 10.6 3.7 3.7 7.5-8.6" stroke-width="2.2"/>',
  cross: '<path d="m5.4 5.4 9.2 9.2M14.6 5.4l-9.2 9.2" stroke-width="2.2"/>',
  dash: '<path d="M5 10h10" stroke-width="2.2"/>',
  warn: '<path d="M10 3 18 16.6H2z"/><path d="M10 8v4.2M10 14.4v.1"/>',
  info: '<circle cx="10" cy="10" r="7.4"/><path d="M10 9.2v4.6M10 6.2v.1"/>',
  close: '<path d="m5 5 10 10M15 5 5 15"/>',
  bulb: '<path d="M7.4 13.2a4.9 4.9 0 1 1 5.2 0v1.6H7.4z"/><path d="M8 17.4h4"/>',
  cube: '<path d="m10 2.6 6.4 3.7v7.4L10 17.4l-6.4-3.7V6.3z"/><path d="m3.6 6.3 6.4 3.7 6.4-3.7M10 10v7.4"/>',
  fit: '<path d="M3.5 7V3.5H7M13 3.5h3.5V7M16.5 13v3.5H13M7 16.5H3.5V13"/><circle cx="10" cy="10" r="2.4"/>',
  full: '<path d="M3.5 8V3.5H8M12 3.5h4.5V8M16.5 12v4.5H12M8 16.5H3.5V12M3.5 3.5 8 8M16.5 3.5 12 8M16.5 16.5 12 12M3.5 16.5 8 12"/>',
  link: '<path d="M8.4 11.6a3.4 3.4 0 0 0 4.8 0l2.6-2.6A3.4 3.4 0 0 0 11 4.2l-1 1"/><path d="M11.6 8.4a3.4 3.4 0 0 0-4.8 0L4.2 11A3.4 3.4 0 0 0 9 15.8l1-1"/>',
  projector:
    '<rect x="2.5" y="3.5" width="15" height="10" rx="1.2"/><path d="M10 13.5v3M6.5 16.8h7M6.4 10.6l2.5-3 2 2 2.6-3.2"/>',
  hand: '<path d="M6 10.4V5.2a1.2 1.2 0 0 1 2.4 0V9M8.4 9V3.9a1.2 1.2 0 0 1 2.4 0V9M10.8 9V4.6a1.2 1.2 0 0 1 2.4 0v6.2M13.2 8.4a1.2 1.2 0 0 1 2.4 0v3.8a4.8 4.8 0 0 1-4.8 4.8H9.6a4.6 4.6 0 0 1-3.9-2.2L3.4 11a1.2 1.2 0 0 1 2-1.3L6 10.4"/>',
  trace: '<path d="M3 15.5c3-11 6-11 7.4-6s3.8 3.4 6.1-5.2"/><circle cx="16.6" cy="4" r="1.6"/>',
  wide: '<path d="M2.5 4h15v12h-15zM7 10H4.6M13 10h2.4"/><path d="M6 8.2 4.2 10 6 11.8M14 8.2l1.8 1.8-1.8 1.8"/>',
  save: '<path d="M10 3v9M6.4 8.8 10 12.4l3.6-3.6M4 16.4h12"/>',
} as const;

export type IconName = keyof typeof PATHS;

export function icon(name: IconName): SVGSVGElement {
  const element = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  element.setAttribute("viewBox", "0 0 20 20");
  element.setAttribute("class", "icon");
  element.setAttribute("aria-hidden", "true");
  element.innerHTML = PATHS[name];
  return element;
}
