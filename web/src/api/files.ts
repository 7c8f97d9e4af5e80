// A site of plain files: what the server would answer lies in files beside the page.

import { fileOf } from "../core/address";
import { t } from "../core/texts";

/** The address of the file that answers a path; what is in a query is the same for everybody here. */
export function fileUrl(path: string): string {
  // A colon is no character of file names everywhere.
  const plain = (path.split("?")[0] ?? path).replaceAll(/%3A|:/g, "-");
  return fileOf(`data${plain}${/\/(?:starters\/\w+)$/.test(plain) ? ".txt" : ".json"}`);
}

/** The answer that lies in a file. */
export async function fileAnswer(path: string): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(fileUrl(path));
  } catch {
    return refusal(
      t("The files of this site cannot be reached"),
      503,
      t("Connect once more, then it works without a network."),
    );
  }
  // Hosts of files answer with a page of their own where there is nothing.
  return response.ok ? response : needsServer();
}

/** What a site of files cannot do: answers are checked, and kept, where the secrets are. */
export const needsServer = (): Response =>
  refusal(
    t("This copy of the course has no server"),
    501,
    t(
      "Lessons, mechanisms and their numbers work here. To have answers checked and kept, open the course on your class's server, or run “triad” on your own machine.",
    ),
  );

function refusal(title: string, status: number, hint: string): Response {
  const problem = { title, status, code: "no-server", hint };
  return new Response(JSON.stringify(problem), {
    status,
    headers: { "content-type": "application/problem+json" },
  });
}
