/** Length of the unpacked viewer, set at build time. */
declare const __VIEWER_BYTES__: number;
/** A style sheet as text. */
declare module "*.css?inline" {
  const text: string;
  export default text;
}

/** Where the engine for this page is; undefined in a build without it. */
declare module "virtual:triad-engine" {
  const url: string | undefined;
  export default url;
}
