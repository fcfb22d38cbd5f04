/** The machine's API, as /api/openapi.json describes it. */
const reply = async (response) => {
  const body = await response.json();
  if (!response.ok) throw new Error([body.error, body.help].filter(Boolean).join("; "));
  return body;
};

export const get = async (what) => reply(await fetch(`/api/${what}`));

/** Asks for the token when one is needed, and keeps it as long as the page is open. */
export async function post(what, body = {}) {
  const send = () => {
    const token = sessionStorage.getItem("token");
    const headers = token ? { Authorization: `Bearer ${token}` } : {};
    return fetch(`/api/${what}`, { method: "POST", headers, body: JSON.stringify(body) });
  };
  let response = await send();
  if (response.status === 403 && (await response.clone().text()).includes("the token")) {
    const token = prompt("Token of the machine");
    if (token) {
      sessionStorage.setItem("token", token);
      response = await send();
    }
  }
  return reply(response);
}
