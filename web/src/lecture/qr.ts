// An address as a QR picture, dark on light in every theme: phones want it so.

import { encode } from "uqr";
import { svg } from "../core/dom";
import { t } from "../core/texts";

export function qr(text: string): SVGSVGElement {
  const code = encode(text, { ecc: "M", border: 2 });
  const d = code.data.flatMap((row, y) => row.map((dark, x) => (dark ? `M${x} ${y}h1v1h-1z` : ""))).join("");
  return svg(
    "svg",
    {
      viewBox: `0 0 ${code.size} ${code.size}`,
      class: "qr",
      role: "img",
      "aria-label": t("QR code of {text}", { text }),
      "shape-rendering": "crispEdges",
    },
    svg("rect", { width: code.size, height: code.size, fill: "#fff" }),
    svg("path", { d, fill: "#000" }),
  );
}
