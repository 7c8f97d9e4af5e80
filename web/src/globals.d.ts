/** Length of the unpacked viewer, set at build time. */
declare const __VIEWER_BYTES__: number;
/** A style sheet as text. */
declare module "*.css?inline" {
  const text: string;
  export default text;
}
