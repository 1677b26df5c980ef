// Runs a page's work on the question that its test asks, and posts the answer or what went wrong.
export async function answer(work) {
    let said;
    try {
        said = await work(await (await fetch("/question")).json());
    } catch (error) {
        said = { error: String(error.stack ?? error) };
    }
    await fetch("/answer", { method: "POST", body: JSON.stringify(said) });
}
