// Two build steps of our own: lighter KaTeX fonts, and files packed ahead of time.
import { readdir, readFile, rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { promisify } from "node:util";
import { brotliCompress, constants } from "node:zlib";
import type { Plugin } from "vite";

const toBrotli = promisify(brotliCompress);

const COMPRESSED = /\.(?:js|css|wasm|svg|json)$/;
const SMALLEST = 1024;
const LARGE = 4 * 1024 * 1024;

/** Every browser that runs the viewer reads woff2, so the woff and ttf copies are left out. */
export function onlyWoff2(): Plugin {
  return {
    name: "triad-only-woff2",
    enforce: "pre",
    transform(code, id) {
      if (!id.split("?")[0]?.endsWith("katex.min.css")) return null;
      const lighter = code.replace(/,url\([^)]*\.(?:woff|ttf)\)\s*format\("[^"]*"\)/g, "");
      return { code: lighter, map: null };
    },
  };
}

/**
 * Packs every asset above 1 KB: FILE.br takes the place of FILE, so that the server carries each once
 * (the viewer has 47 MB unpacked). What else a browser may ask for, the server makes of it.
 */
export function compressAhead(): Plugin {
  let outDir = "dist";
  return {
    name: "triad-compress-ahead",
    apply: "build",
    configResolved(config) {
      outDir = join(config.root, config.build.outDir);
    },
    async closeBundle() {
      const folder = join(outDir, "assets");
      for (const name of await readdir(folder)) {
        if (!COMPRESSED.test(name)) continue;
        const file = join(folder, name);
        const bytes = await readFile(file);
        if (bytes.length <= SMALLEST) continue;
        const large = bytes.length > LARGE;
        // Quality 7 packs the viewer in a few seconds; 11 would take minutes for 5 % less.
        const brotli = await toBrotli(bytes, {
          params: {
            [constants.BROTLI_PARAM_QUALITY]: large ? 7 : 11,
            [constants.BROTLI_PARAM_LGWIN]: large ? 24 : 22,
            [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length,
          },
        });
        await writeFile(`${file}.br`, brotli);
        await rm(file);
      }
    },
  };
}
