// Writes src/api/schema.ts from the server's OpenAPI document; with --check it only says whether that file is current.
import { readFileSync, writeFileSync } from "node:fs";
import openapiTS, { astToString } from "openapi-typescript";

const DOCUMENT = new URL("../../server/openapi.json", import.meta.url);
const TYPES = new URL("../src/api/schema.ts", import.meta.url);
const HEAD = "// Generated from server/openapi.json by `npm run types`: do not edit.\n\n";

/** Lists of a fixed length become tuples, which the generator makes of `prefixItems` only. */
function withTuples(value) {
  if (Array.isArray(value)) return value.map(withTuples);
  if (typeof value !== "object" || value === null) return value;
  const { minItems, maxItems, ...rest } = Object.fromEntries(
    Object.entries(value).map(([key, part]) => [key, withTuples(part)]),
  );
  if (rest.items && !rest.prefixItems && minItems === maxItems && minItems > 0) {
    rest.prefixItems = Array(minItems).fill(rest.items);
    delete rest.items;
  }
  return rest;
}

/** TypeScript cannot name a union that is a list of itself: its elements are of unknown type. */
function withoutLoop([name, schema]) {
  const self = JSON.stringify({ $ref: `#/components/schemas/${name}` });
  const loops = !schema.properties && JSON.stringify(schema).includes(`"items":${self}`);
  return [
    name,
    loops ? JSON.parse(JSON.stringify(schema).replaceAll(`"items":${self}`, `"items":{}`)) : schema,
  ];
}

const { components, ...document } = JSON.parse(readFileSync(DOCUMENT, "utf8"));
const schemas = withTuples(Object.fromEntries(Object.entries(components.schemas).map(withoutLoop)));
// The page writes its requests by hand: it needs the shapes only.
const shapes = { ...document, paths: {}, components: { schemas } };
const text = HEAD + astToString(await openapiTS(shapes, { defaultNonNullable: false }));
if (!process.argv.includes("--check")) writeFileSync(TYPES, text);
else if (readFileSync(TYPES, "utf8") !== text) {
  console.error("src/api/schema.ts differs from server/openapi.json: run `npm run types`.");
  process.exit(1);
}
