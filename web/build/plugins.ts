// Build steps of our own: lighter KaTeX fonts, the engine for the page, and files packed ahead of time.
import { readdir, readFile, rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { promisify } from "node:util";
import { brotliCompress, constants } from "node:zlib";
import { build, type Plugin } from "vite";

const toBrotli = promisify(brotliCompress);

const COMPRESSED = /\.(?:js|css|wasm|svg|json)$/;
const SMALLEST = 1024;
const LARGE = 16 * 1024 * 1024;

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

const ENGINE = "virtual:triad-engine";

/**
 * The engine for the page, where it was built: `virtual:triad-engine` is its address, or undefined without it. The program's
 * build script builds it and names the file; other builds take what is there.
 */
export function engine(file: string | undefined): Plugin {
  let building = false;
  return {
    name: "triad-engine",
    configResolved(config) {
      building = config.command === "build";
    },
    resolveId: (id) => (id === ENGINE ? `\0${ENGINE}` : null),
    async load(id) {
      if (id !== `\0${ENGINE}`) return null;
      if (!file) return "export default undefined;";
      if (!building) return `export default ${JSON.stringify(`/@fs${file}`)};`;
      const asset = this.emitFile({ type: "asset", name: "engine.wasm", source: await readFile(file) });
      return `export default import.meta.ROLLUP_FILE_URL_${asset};`;
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

const PLAYER = "player.html";

/** Makes player.html beside the page: a file that plays a recorded run by itself, once a motion is put into it. */
export function offlinePlayer(): Plugin {
  let root = "";
  let outDir = "dist";
  return {
    name: "triad-offline-player",
    configResolved(config) {
      root = config.root;
      outDir = join(config.root, config.build.outDir);
    },
    configureServer(server) {
      server.middlewares.use(`/${PLAYER}`, (_, answer) => {
        playerFile(root).then(
          (text) => answer.setHeader("content-type", "text/html").end(text),
          (error: unknown) => answer.writeHead(500).end(String(error)),
        );
      });
    },
    async closeBundle() {
      await writeFile(join(outDir, PLAYER), await playerFile(root));
    },
  };
}

async function playerFile(root: string): Promise<string> {
  const built = await build({
    configFile: false,
    root,
    logLevel: "error",
    build: {
      write: false,
      target: "es2022",
      modulePreload: false,
      rollupOptions: {
        input: join(root, "src/player/file.ts"),
        output: { format: "iife", inlineDynamicImports: true },
      },
    },
  });
  const [one] = Array.isArray(built) ? built : [built];
  const chunk = one && "output" in one ? one.output[0] : undefined;
  if (chunk?.type !== "chunk") throw new Error("the player was not built");
  // The place for the motion is that of src/player/played.ts.
  return (
    `<!doctype html><html lang="en"><head><meta charset="utf-8">` +
    `<meta name="viewport" content="width=device-width, initial-scale=1"><title>Triad</title></head><body>` +
    `<script type="application/json" id="motion"></script>` +
    `<script>${chunk.code.replaceAll("</script", "<\\/script")}</script></body></html>\n`
  );
}
