/** Length of the unpacked viewer, set at build time. */
declare const __VIEWER_BYTES__: number;
