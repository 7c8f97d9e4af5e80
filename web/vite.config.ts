import { statSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { defineConfig } from "vite";
import { compressAhead, engine, offlinePlayer, onlyWoff2 } from "./build/plugins";

const viewerWasm = fileURLToPath(
  new URL("./node_modules/@rerun-io/web-viewer/re_viewer_bg.wasm", import.meta.url),
);
const server = process.env.TRIAD_SERVER ?? "http://127.0.0.1:8080";

export default defineConfig({
  plugins: [onlyWoff2(), engine(process.env.TRIAD_ENGINE_WASM), compressAhead(), offlinePlayer()],
  define: {
    // The unpacked size, for an honest progress bar: over the wire the length is the packed one.
    __VIEWER_BYTES__: JSON.stringify(statSync(viewerWasm).size),
  },
  build: {
    target: "es2022",
    assetsInlineLimit: 2048,
    chunkSizeWarningLimit: 1024,
    reportCompressedSize: false,
    modulePreload: { polyfill: false },
  },
  experimental: {
    // Only the page itself names its files from the root, as it answers at many paths; files name each other from where
    // they lie, so that a site of files can lie in any folder.
    renderBuiltUrl: (_, { hostType }) => (hostType === "html" ? undefined : { relative: true }),
  },
  // The viewer finds its .wasm relative to its own module, which pre-bundling would move.
  optimizeDeps: { exclude: ["@rerun-io/web-viewer"] },
  server: {
    proxy: { "/api": { target: server, ws: true, changeOrigin: false } },
  },
});
